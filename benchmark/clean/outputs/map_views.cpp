// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/map_views.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "benchmark/picture/canvas/colours.h"
#include "benchmark/report/page.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// The longer side of a picture, and its margin.
constexpr double kPicturePixels = 1600.0;
constexpr int kPictureMargin = 20;
constexpr int kTitleHeight = 30, kLegendHeight = 30;

/// The colours of correct verdicts in pictures of labelled data: without labels no verdict is known
/// to be wrong.
constexpr Outcome kKept = Outcome::kKeptStatic, kRemoved = Outcome::kTruePositive;

constexpr Colour kPath = verdict_colours::kFalsePositive;

void draw_legend(Canvas& canvas, int x, int y, bool with_path) {
  std::vector<std::pair<Colour, const char*>> entries = {{outcome_colour(kRemoved), "removed"},
                                                         {outcome_colour(kKept), "kept"}};
  if (with_path) entries.emplace_back(kPath, "path of the sensor");
  for (const auto& [colour, name] : entries) {
    canvas.fill(x, y - 11, 13, 13, colour);
    canvas.text(x + 19, y, name, 13, kInk);
    x += 19 + canvas.text_width(name, 13) + 24;
  }
}

}  // namespace

MapPictureFile::MapPictureFile(const std::filesystem::path& path, ViewTexts texts,
                               const Pose& T_upright_world, const WorldWindow& window)
    : file_(path),
      texts_(std::move(texts)),
      T_upright_world_(T_upright_world),
      window_(window),
      resolution_(std::max(window.width(), window.height()) / kPicturePixels),
      raster_(window, resolution_) {}

void MapPictureFile::add(const CleanedScan& scan) {
  if (texts_.with_path) path_.push_back(T_upright_world_ * scan.scan.T_world_sensor.translation());
  for (std::size_t i = 0; i < scan.mask.size(); ++i) {
    if (scan.mask[i] > 1) continue;
    raster_.add(T_upright_world_ * scan.rows.world[i], scan.mask[i] != 0 ? kRemoved : kKept);
  }
}

/// Draws a dot each half pixel, so that the path is a line.
void MapPictureFile::draw_path(Canvas& canvas, int x, int y) const {
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const Eigen::Vector3d step = path_[i] - path_[i > 0 ? i - 1 : 0];
    const int dots = 1 + static_cast<int>(2.0 * step.norm() / resolution_);
    for (int k = 0; k < dots; ++k) {
      const Eigen::Vector3d at = path_[i] - step * (static_cast<double>(k) / dots);
      if (!window_.contains(at)) continue;
      canvas.fill(x + static_cast<int>((at.x() - window_.x_min) / resolution_) - 1,
                  y + static_cast<int>((window_.y_max - at.y()) / resolution_) - 1, 3, 3, kPath);
    }
  }
}

void MapPictureFile::finish() {
  const int width = std::max(raster_.width(), 420), top = kPictureMargin + kTitleHeight;
  Canvas canvas(width + 2 * kPictureMargin,
                top + raster_.height() + kLegendHeight + kPictureMargin);
  canvas.text(kPictureMargin, kPictureMargin + 16,
              canvas.fitted(texts_.sequence + ", cleaned by " + texts_.method, 16, width), 16,
              kInk);
  raster_.draw(canvas, kPictureMargin, top);
  draw_path(canvas, kPictureMargin, top);
  canvas.frame(kPictureMargin, top, raster_.width(), raster_.height(), kBorder);
  draw_scale_bar(canvas, kPictureMargin + 10, top + raster_.height() - 12, resolution_,
                 raster_.width() / 3);
  draw_legend(canvas, kPictureMargin, top + raster_.height() + kLegendHeight, texts_.with_path);
  file_.append(canvas.png_bytes());
  file_.sync();
}

MapPageFile::MapPageFile(const std::filesystem::path& path, ViewTexts texts,
                         const Pose& T_upright_world)
    : file_(path),
      texts_(std::move(texts)),
      scene_(texts_.sequence, texts_.method, T_upright_world, kMostPoints) {}

void MapPageFile::add(const CleanedScan& scan) {
  scene_.add(scan.scan, scan.mask, scan.confidence);
}

void MapPageFile::finish() {
  const Scene scene = scene_.finish();
  const VerdictCounts& counts = scene.counts.front();
  const std::uint64_t removed = counts.true_positive;
  file_.append(map_page(scene, texts_.sequence + ", cleaned by " + texts_.method,
                        {counted_text(scene.scans.size(), "scan") + " with " +
                             counted_text(scene.points_in_range, "point") + ".",
                         texts_.method + " removed " + grouped_text(removed) +
                             " of them and kept " + grouped_text(counts.kept_static) + "."}));
  file_.sync();
}

}  // namespace raymoval
