// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_outputs.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/clean/outputs/clean_output.h"
#include "benchmark/clean/outputs/output_folder.h"
#include "benchmark/clean/outputs/scan_folder.h"
#include "benchmark/clean/rows/map_rows.h"
#include "benchmark/picture/canvas/colours.h"
#include "benchmark/picture/maps/map_picture.h"
#include "benchmark/picture/maps/top_down.h"
#include "benchmark/report/page.h"
#include "benchmark/report/scene.h"
#include "benchmark/result/removals/removal_files.h"
#include "core/error.h"
#include "core/files/file_writer.h"
#include "core/files/replacements.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"

namespace raymoval {
namespace {

/// The kept or the removed points in the world frame. With a voxel size it holds a row for each
/// occupied cell, so that memory is bounded by the map. Without one it passes rows on as they come,
/// and memory is bounded by a scan.
class MapOutput : public CleanOutput {
 public:
  /// @param mask of the points that it has: 0 = kept, 1 = removed
  /// @param layout of all rows
  /// @param voxel_size in metres; 0 keeps every point
  /// @throws UsageError, DataError as `PointRecordWriter`
  MapOutput(const std::filesystem::path& path, const RecordLayout& layout, std::uint8_t mask,
            double voxel_size, const Eigen::Vector3d& voxel_origin);

  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { file_.commit_with(together); }
  [[nodiscard]] std::uint64_t points() const override { return points_; }

 private:
  void write(const ScanRows& rows);

  PointRecordWriter file_;
  std::uint8_t mask_;
  std::optional<VoxelRows> cells_;
  std::uint64_t points_ = 0;
};

MapOutput::MapOutput(const std::filesystem::path& path, const RecordLayout& layout,
                     std::uint8_t mask, double voxel_size, const Eigen::Vector3d& voxel_origin)
    : file_(path), mask_(mask) {
  file_.start(layout);
  if (voxel_size > 0.0) cells_.emplace(layout, voxel_size, voxel_origin);
}

void MapOutput::write(const ScanRows& rows) {
  points_ += rows.rows.size();
  file_.add(rows.rows);
}

void MapOutput::add(const CleanedScan& scan) {
  if (cells_) {
    for (std::size_t i = 0; i < scan.mask.size(); ++i) {
      if (scan.mask[i] == mask_) cells_->add(scan.rows, i);
    }
    return;
  }
  std::vector<std::uint8_t> chosen(scan.mask.size());
  std::transform(scan.mask.begin(), scan.mask.end(), chosen.begin(),
                 [this](std::uint8_t mask) { return mask == mask_ ? 1 : 0; });
  const auto count = static_cast<std::size_t>(std::count(chosen.begin(), chosen.end(), 1));
  if (count == 0) return;
  if (count == chosen.size()) return write(scan.rows);
  write({scan.rows.rows.chosen(chosen), {}});
}

void MapOutput::finish() {
  if (cells_) cells_->take([this](const ScanRows& piece) { write(piece); });
  file_.finish();
}

/// The texts of pictures and pages of a cleaned map.
struct ViewTexts {
  std::string sequence, method;
  bool with_path = false;  ///< Whether the picture shows the path of the sensor.
};

/// The cleaned map from above as a PNG: kept points are grey, removed points coloured. Memory is
/// bounded by the picture.
class MapPictureFile : public CleanOutput {
 public:
  /// @param window in the upright world, metres
  MapPictureFile(const std::filesystem::path& path, ViewTexts texts, const Pose& T_upright_world,
                 const WorldWindow& window);
  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { file_.commit_with(together); }

 private:
  void draw_path(Canvas& canvas, int x, int y) const;

  FileWriter file_;
  ViewTexts texts_;
  Pose T_upright_world_;
  WorldWindow window_;
  double resolution_;  ///< Metres per pixel.
  TopDownRaster raster_;
  std::vector<Eigen::Vector3d> path_;  ///< Of the sensor, in the upright world.
};

/// The cleaned map as a page for review. Memory is bounded by the points that it shows.
class MapPageFile : public CleanOutput {
 public:
  /// Points that a page shows at most.
  static constexpr std::size_t kMostPoints = 1'000'000;

  MapPageFile(const std::filesystem::path& path, ViewTexts texts, const Pose& T_upright_world);
  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { file_.commit_with(together); }

 private:
  FileWriter file_;
  ViewTexts texts_;
  MapSceneBuilder scene_;
};

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

/// A label file for each scan: 251 = removed, 9 = kept, 0 = in no output.
class LabelFolder : public CleanOutput {
 public:
  explicit LabelFolder(const std::filesystem::path& path) : folder_(path) {}
  void add(const CleanedScan& scan) override {
    write_removal(folder_.place(), scan.scan, scan.mask);
  }
  void finish() override {}
  void commit_with(Replacements& together) override { folder_.commit_with(together); }

 private:
  OutputFolder folder_;
};

bool is_map(const OutputPath& output) {
  return output.kind == OutputKind::kCloud;
}

/// @throws UsageError if the confidence is requested but no output can hold it
void check_confidence(const std::vector<OutputPath>& outputs, const CleanWriting& writing) {
  if (!writing.confidence || std::any_of(outputs.begin(), outputs.end(), is_map)) return;
  throw UsageError(
      "--confidence has no effect: it is a field of maps, and none is written. Name one with -o, "
      "or leave it out.");
}

}  // namespace

CleanOutputs::CleanOutputs(const CleanPaths& paths, const CleanWriting& writing,
                           const Sequence& sequence, Progress& progress,
                           const std::atomic<bool>& cancel)
    : sequence_(sequence) {
  const std::vector<OutputPath> all = paths.all();
  check_confidence(all, writing);
  const MapPrecision precision = map_precision(*sequence.scans);
  const bool needs_rows = std::any_of(all.begin(), all.end(), [](const OutputPath& output) {
    return output.kind != OutputKind::kLabels;
  });
  std::optional<ScanFolderPlan> plan;
  if (!paths.scans.empty()) plan = plan_scan_folder(sequence);
  if (needs_rows) {
    rows_.emplace(sequence, precision.coordinates, progress, cancel);
    layout_ = writing.confidence ? layout_with_confidence(rows_->layout()) : rows_->layout();
    has_confidence_ = writing.confidence;
  }
  for (const OutputPath& output : all) {
    if (is_map(output)) add_map(output, writing, precision.origin);
  }
  if (rows_ && rows_->is_widened() && first_map_ != nullptr) {
    notes_.push_back(
        "The map lies more than 8 km from the world's origin: its coordinates are float64.");
  }
  if (!paths.labels.empty()) outputs_.push_back(std::make_unique<LabelFolder>(paths.labels));
  if (plan) {
    has_own_poses_ = plan->own_poses;
    outputs_.push_back(std::make_unique<ScanFolder>(paths.scans, sequence, std::move(*plan)));
  }
  add_views(paths, writing);
}

void CleanOutputs::note_losses(const OutputPath& output, const RecordLayout& layout) {
  for (const std::string& lost : format_losses(output.path, layout)) {
    notes_.push_back(output.option + ": " + lost);
  }
}

void CleanOutputs::add_map(const OutputPath& output, const CleanWriting& writing,
                           const Eigen::Vector3d& voxel_origin) {
  const std::uint8_t mask = output.option == "--dynamic" ? 1 : 0;
  if (rows_->is_widened()) check_coordinates(output.path, Coordinates::kDouble);
  note_losses(output, layout_);
  auto map =
      std::make_unique<MapOutput>(output.path, layout_, mask, writing.voxel_size, voxel_origin);
  if (first_map_ == nullptr) first_map_ = map.get();
  outputs_.push_back(std::move(map));
}

void CleanOutputs::add_views(const CleanPaths& paths, const CleanWriting& writing) {
  const ViewTexts texts{sequence_.name, writing.method, !sequence_.made_poses.empty()};
  if (!paths.page.empty()) {
    outputs_.push_back(std::make_unique<MapPageFile>(paths.page, texts, sequence_.upright_frame()));
  }
  if (paths.picture.empty()) return;
  const LocalFrameSource upright(*sequence_.scans, sequence_.upright_frame());
  outputs_.push_back(std::make_unique<MapPictureFile>(
      paths.picture, texts, sequence_.upright_frame(), window_around_way(upright)));
}

void CleanOutputs::add(const Scan& scan, const Mask& mask, const std::string& confidence) {
  std::optional<PointRecords> stored;
  if (sequence_.records != nullptr && rows_) stored = sequence_.records->records(scan.index);
  const PointRecords* records = stored ? &*stored : nullptr;
  ScanRows rows = rows_ ? rows_->rows(scan, records) : ScanRows{};
  if (has_confidence_) rows = rows_with_confidence(rows, layout_, confidence);
  const CleanedScan cleaned{scan, mask, rows, records, confidence};
  for (const auto& output : outputs_) output->add(cleaned);
}

void CleanOutputs::commit() {
  for (const auto& output : outputs_) output->finish();
  Replacements all;
  // The map comes last: where it is, the others are.
  for (auto output = outputs_.rbegin(); output != outputs_.rend(); ++output) {
    (*output)->commit_with(all);
  }
  all.commit();
}

std::optional<std::uint64_t> CleanOutputs::map_points() const {
  if (first_map_ == nullptr) return std::nullopt;
  return first_map_->points();
}

std::vector<std::string> CleanOutputs::results() const {
  std::vector<std::string> results;
  for (const auto& output : outputs_) {
    const std::vector<std::string> remarks = output->remarks();
    results.insert(results.end(), remarks.begin(), remarks.end());
  }
  return results;
}

}  // namespace raymoval
