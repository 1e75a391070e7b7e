// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/top_down.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/progress.h"
#include "core/text.h"
#include "eval/columns/removal_tally.h"

namespace raymoval {
namespace {

struct OutcomeStyle {
  Colour colour;
  const char* name;
};
/// In the order of `Outcome`.
constexpr std::array<OutcomeStyle, kOutcomes> kOutcomeStyles = {
    {{verdict_colours::kKeptStatic, "static, kept"},
     {verdict_colours::kTruePositive, "moving, removed"},
     {verdict_colours::kFalsePositive, "static, removed"},
     {verdict_colours::kFalseNegative, "moving, kept"}}};

/// A moving object is always above many static points, so one moving point counts as much as this
/// many static points.
constexpr std::uint64_t kMovingWeight = 10;

/// Pixels with few points are light grey, pixels of walls are dark.
Colour static_grey(std::uint32_t points) {
  const double share = std::min(1.0, std::log2(1.0 + points) / 8.0);
  const auto level = static_cast<std::uint8_t>(std::lround(226.0 - 110.0 * share));
  return {level, level, level};
}

}  // namespace

Colour outcome_colour(Outcome outcome) {
  return kOutcomeStyles[static_cast<std::size_t>(outcome)].colour;
}

const char* outcome_name(Outcome outcome) {
  return kOutcomeStyles[static_cast<std::size_t>(outcome)].name;
}

void for_each_shown_point(const Sequence& sequence, const ScanSource& scans,
                          const std::vector<MaskStore>& masks, const std::string& task,
                          const OpenContext& context, const VisitPoint& visit) {
  const LabelClasses classes(sequence.label_rule);
  const RangeLimits range_m(sequence.range_m);
  if (context.progress != nullptr) context.progress->begin(task, scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    throw_if_cancelled(context.cancel);
    const Scan scan = scans.load(i);
    const std::vector<std::uint32_t> labels = sequence.labels->labels(scan);
    std::vector<Mask> removed;
    for (const MaskStore& store : masks) removed.push_back(store.get(i));
    for (std::size_t k = 0; k < scan.size(); ++k) {
      const Eigen::Vector3d point = scan.points[k].cast<double>();
      if (classes.of(labels[k]) == LabelClass::kIgnored || !range_m.contains(point.norm()) ||
          point.head<2>().norm() < kMinimumHorizontalRange) {
        continue;
      }
      const Eigen::Vector3d world = scan.T_world_sensor * point;
      const bool moving = classes.moving(labels[k]);
      for (std::size_t m = 0; m < masks.size(); ++m) {
        visit(m, {world, outcome_of(moving, removed[m][k] != 0)});
      }
    }
    if (context.progress != nullptr) context.progress->advance();
  }
}

WorldWindow window_around(const std::vector<Eigen::Vector3d>& places, double around) {
  if (places.empty()) return {-around, around, -around, around};
  WorldWindow window{1e300, -1e300, 1e300, -1e300};
  for (const Eigen::Vector3d& at : places) {
    window.x_min = std::min(window.x_min, at.x() - around);
    window.x_max = std::max(window.x_max, at.x() + around);
    window.y_min = std::min(window.y_min, at.y() - around);
    window.y_max = std::max(window.y_max, at.y() + around);
  }
  return window;
}

TopDownRaster::TopDownRaster(const WorldWindow& window, double resolution)
    : window_(window),
      resolution_(resolution),
      width_(std::max(1, static_cast<int>(std::ceil(window.width() / resolution - 1e-6)))),
      height_(std::max(1, static_cast<int>(std::ceil(window.height() / resolution - 1e-6)))),
      counts_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void TopDownRaster::add(const Eigen::Vector3d& world, Outcome outcome) {
  const double x = std::floor((world.x() - window_.x_min) / resolution_);
  const double y = std::floor((window_.y_max - world.y()) / resolution_);
  if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return;
  const auto place =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  ++counts_[place][static_cast<std::size_t>(outcome)];
}

bool TopDownRaster::shown(int x, int y, Outcome& outcome) const {
  const auto count = [&here = counts(x, y)](Outcome of) -> std::uint64_t {
    return here[static_cast<std::size_t>(of)];
  };
  const std::uint64_t found = count(Outcome::kTruePositive), left = count(Outcome::kFalseNegative);
  const std::uint64_t lost = count(Outcome::kFalsePositive), kept = count(Outcome::kKeptStatic);
  if (found + left + lost + kept == 0) return false;
  if (found + left > 0 && kMovingWeight * (found + left) >= lost + kept) {
    outcome = left >= found ? Outcome::kFalseNegative : Outcome::kTruePositive;
  } else {
    outcome = lost >= kept ? Outcome::kFalsePositive : Outcome::kKeptStatic;
  }
  return true;
}

void TopDownRaster::draw(Canvas& canvas, int left, int top) const {
  canvas.draw_pixels(left, top, width_, height_, [&](int x, int y) -> std::optional<Colour> {
    Outcome outcome = Outcome::kKeptStatic;
    if (!shown(x, y, outcome)) return std::nullopt;
    return outcome == Outcome::kKeptStatic
               ? static_grey(counts(x, y)[static_cast<std::size_t>(outcome)])
               : outcome_colour(outcome);
  });
}

void draw_scale_bar(Canvas& canvas, int x, int y, double resolution, int most_pixels) {
  double metres = 0.01;
  for (double power = 0.01; power < 1e5; power *= 10.0) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      if (digit * power / resolution <= most_pixels) metres = digit * power;
    }
  }
  const int length = std::max(1, static_cast<int>(std::lround(metres / resolution)));
  const std::string name = fixed_text(metres, metres < 1.0 ? 2 : 0) + " m";
  canvas.fill(x - 3, y - 19, std::max(length, canvas.text_width(name, 12)) + 6, 26, kPaper);
  canvas.fill(x, y, length, 3, kInk);
  canvas.fill(x, y - 3, 1, 6, kInk);
  canvas.fill(x + length - 1, y - 3, 1, 6, kInk);
  canvas.text(x, y - 6, name, 12, kInk);
}

int draw_outcome_legend(Canvas& canvas, int x, int y, int size) {
  int at = x;
  for (const Outcome outcome : kLegendOrder) {
    canvas.fill(at, y - size + 2, size, size, outcome_colour(outcome));
    canvas.text(at + size + 6, y, outcome_name(outcome), size, kInk);
    at += size + 6 + canvas.text_width(outcome_name(outcome), size) + 24;
  }
  return at - x;
}

}  // namespace raymoval
