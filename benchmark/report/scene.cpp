// SPDX-License-Identifier: MIT
#include "benchmark/report/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "benchmark/result/removals/reasons.h"
#include "core/morton.h"
#include "core/scan/confidence_store.h"
#include "core/scan/local_frame.h"
#include "eval/columns/removal_tally.h"

namespace raymoval {
namespace {

/// The first size of cells, if no point was thinned before.
constexpr int kFirstCell = kStepsPerVoxel / 4;
constexpr int kLargestCell = 1 << 24;

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  return VoxelKeyHash{}(hash * 0x9E3779B97F4A7C15ULL + value);
}

/// The largest share of wrongly classified points.
constexpr double kErrorShare = 0.6;

/// The largest share of removed points.
constexpr double kRemovedShare = 0.4;

/// SemanticKITTI's ids for kept and removed points.
constexpr std::uint16_t kKeptId = 9, kRemovedId = 251;

/// The Morton code of a point: the bits of its coordinates in turn, z on top.
using Morton = std::array<std::uint64_t, 2>;

Morton morton_of(const ShownPoint& point) {
  Morton code{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto biased = static_cast<std::uint64_t>(std::int64_t{point.step[axis]} + (1LL << 31));
    code[0] |= spread_bits(biased >> 21) << axis;
    code[1] |= spread_bits(biased) << axis;
  }
  return code;
}

/// Puts the points of both sets, and their verdicts, into `scene`, in an order in which neighbours
/// in space are near each other.
void gather_points(const ReportPoints& first, const ReportPoints& second, Scene& scene) {
  const std::size_t count = first.size() + second.size();
  const auto set_of = [&](std::size_t i) -> std::pair<const ReportPoints&, std::size_t> {
    if (i < first.size()) return {first, i};
    return {second, i - first.size()};
  };
  std::vector<Morton> codes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [set, place] = set_of(i);
    codes[i] = morton_of(set.points()[place]);
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
  });
  scene.points.reserve(count);
  const std::size_t bytes = count == 0 ? scene.cells.size() : set_of(0).first.verdict(0).size();
  scene.verdicts.assign(bytes, std::vector<std::uint8_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto [set, place] = set_of(order[i]);
    scene.points.push_back(set.points()[place]);
    const std::span<const std::uint8_t> verdict = set.verdict(place);
    for (std::size_t cell = 0; cell < verdict.size(); ++cell) {
      scene.verdicts[cell][i] = verdict[cell];
    }
  }
}

/// The verdicts of a method on one scan.
struct ScanVerdicts {
  Mask removed;
  std::vector<std::uint8_t> reasons;  ///< Empty if there are none.

  [[nodiscard]] std::uint8_t byte(std::size_t point) const {
    const int reason = reasons.empty() ? 0 : reasons[point] + 1;
    return static_cast<std::uint8_t>(removed[point] | reason << 1);
  }
};

/// Reads a sequence scan by scan and chooses the shown points.
class SceneBuilder {
 public:
  SceneBuilder(const Sequence& sequence, std::vector<SceneCell> cells, std::size_t limit)
      : sequence_(sequence),
        limit_(limit),
        errors_(static_cast<std::size_t>(kErrorShare * static_cast<double>(limit)), cells.size(),
                0),
        others_(limit, cells.size(), kStepsPerVoxel),
        bytes_(cells.size()) {
    scene_.sequence = sequence.name;
    scene_.T_upright_world = sequence.upright_frame();
    scene_.cells = std::move(cells);
    scene_.counts.resize(scene_.cells.size());
    only_controls_ = std::all_of(scene_.cells.begin(), scene_.cells.end(),
                                 [](const SceneCell& cell) { return cell.control; });
  }

  void add(const Scan& scan) {
    scene_.scans.push_back(scan.name);
    scene_.trajectory.push_back(scan.T_world_sensor.translation());
    const std::vector<std::uint32_t> labels = sequence_.labels->labels(scan);
    const std::vector<ScanVerdicts> verdicts = read_verdicts(scan);
    for (std::size_t point = 0; point < scan.size(); ++point) {
      if (!sequence_.range_m.contains(scan.points[point].cast<double>().norm())) continue;
      add_point(scan, point, labels[point], verdicts);
    }
  }

  Scene finish() {
    others_.reduce(limit_ - errors_.size());
    scene_.error_cell = errors_.cell();
    scene_.other_cell = others_.cell();
    for (const auto& [id, kind] : labels_) {
      scene_.labels.push_back({id, sequence_.label_rule.class_name(id), kind});
    }
    gather_points(errors_, others_, scene_);
    return std::move(scene_);
  }

 private:
  std::vector<ScanVerdicts> read_verdicts(const Scan& scan) {
    std::vector<ScanVerdicts> verdicts;
    for (const SceneCell& cell : scene_.cells) {
      verdicts.push_back(
          {cell.masks.get(scan.index), read_reasons(cell.removals, scan, cell.sentences.size())});
    }
    return verdicts;
  }

  void add_point(const Scan& scan, std::size_t point, std::uint32_t word,
                 const std::vector<ScanVerdicts>& verdicts) {
    const LabelClass kind = sequence_.label_rule.classify(word);
    labels_.emplace(semantic_id(word), kind);
    ++scene_.points_in_range;
    bool wrong = false;
    std::uint64_t group = kind == LabelClass::kMoving ? scan.index + 1 : 0;
    std::uint64_t error_group = group;
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      bytes_[i] = verdicts[i].byte(point);
      const bool removed = verdicts[i].removed[point] != 0;
      if (kind == LabelClass::kIgnored) continue;
      count(scene_.counts[i], kind, removed);
      if (scene_.cells[i].control && !only_controls_) continue;
      wrong |= removed != (kind == LabelClass::kMoving);
      error_group = error_group * 0x100000001B3ULL + (removed ? 2 : 1);
    }
    if (kind == LabelClass::kIgnored) group = ~std::uint64_t{0};
    const ShownPoint shown{map_steps(scan.T_world_sensor * scan.points[point].cast<double>()),
                           static_cast<std::uint32_t>(scan.index), semantic_id(word)};
    (wrong ? errors_ : others_).add(shown, wrong ? error_group : group, bytes_);
  }

  static void count(VerdictCounts& counts, LabelClass kind, bool removed) {
    if (kind == LabelClass::kMoving) {
      ++(removed ? counts.true_positive : counts.false_negative);
    } else {
      ++(removed ? counts.false_positive : counts.kept_static);
    }
  }

  const Sequence& sequence_;
  std::size_t limit_;
  ReportPoints errors_, others_;
  std::vector<std::uint8_t> bytes_;  ///< The verdict of each cell on the current point.
  std::map<std::uint16_t, LabelClass> labels_;
  bool only_controls_ = false;
  Scene scene_;
};

}  // namespace

// Two cells with the same 64-bit hash are thinned as one. With a million cells, this happens once
// in tens of millions of reports, and costs one shown point.
std::uint64_t ReportPoints::key(const ShownPoint& point, std::uint64_t group) const {
  std::uint64_t hash = group;
  for (const std::int32_t place : map_cell(point.step, cell_)) {
    hash = mixed(hash, static_cast<std::uint64_t>(std::int64_t{place}));
  }
  return hash;
}

void ReportPoints::add(const ShownPoint& point, std::uint64_t group,
                       std::span<const std::uint8_t> verdict) {
  if (cell_ > 0 && !taken_.insert(key(point, group)).second) return;
  points_.push_back(point);
  groups_.push_back(group);
  bytes_.insert(bytes_.end(), verdict.begin(), verdict.end());
  while (points_.size() > limit_) grow_cells();
}

void ReportPoints::reduce(std::size_t limit) {
  limit_ = limit;
  while (points_.size() > limit_) grow_cells();
}

void ReportPoints::grow_cells() {
  if (cell_ > kLargestCell) {  // One point of each group is left: there are too many groups.
    points_.resize(limit_);
    groups_.resize(limit_);
    bytes_.resize(limit_ * verdicts_);
    return;
  }
  cell_ = cell_ == 0 ? kFirstCell : cell_ + std::max(1, cell_ / 4);
  thin();
}

void ReportPoints::align(int steps) {
  if (cell_ % steps == 0) return;
  cell_ += steps - cell_ % steps;
  thin();
}

void ReportPoints::thin() {
  taken_.clear();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!taken_.insert(key(points_[i], groups_[i])).second) continue;
    points_[kept] = points_[i];
    groups_[kept] = groups_[i];
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(i * verdicts_), verdicts_,
                bytes_.begin() + static_cast<std::ptrdiff_t>(kept * verdicts_));
    ++kept;
  }
  points_.resize(kept);
  groups_.resize(kept);
  bytes_.resize(kept * verdicts_);
}

Scene build_scene(const Sequence& sequence, std::vector<SceneCell> cells, std::size_t limit,
                  Progress* progress) {
  SceneBuilder builder(sequence, std::move(cells), limit);
  const LocalFrameSource upright(*sequence.scans, sequence.upright_frame());
  if (progress != nullptr) progress->begin("points of " + sequence.name, sequence.scans->size());
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    builder.add(upright.load(i));
    if (progress != nullptr) progress->advance();
  }
  return builder.finish();
}

MapSceneBuilder::MapSceneBuilder(const std::string& sequence, const std::string& method,
                                 const Pose& T_upright_world, std::size_t limit)
    : limit_(limit),
      removed_(static_cast<std::size_t>(kRemovedShare * static_cast<double>(limit)), 2,
               kStepsPerVoxel),
      kept_(limit, 2, kStepsPerVoxel) {
  scene_.sequence = sequence;
  scene_.T_upright_world = T_upright_world;
  scene_.is_unlabelled = true;
  scene_.cells.push_back({method, false, {}, {}, {}});
  scene_.counts.resize(1);
  scene_.labels = {{kKeptId, "kept", LabelClass::kStatic},
                   {kRemovedId, "removed", LabelClass::kMoving}};
  scene_.review.sequence = sequence;
  scene_.review.method = method;
  scene_.review.R_upright_world = T_upright_world.linear();
}

void MapSceneBuilder::add(const Scan& scan, const Mask& mask, std::string_view confidence) {
  const auto number = static_cast<std::uint32_t>(scene_.scans.size());
  scene_.scans.push_back(scan.name);
  scene_.trajectory.push_back(scene_.T_upright_world * scan.T_world_sensor.translation());
  scene_.review.scans.push_back(reviewed_scan(scan, mask));
  if (!confidence.empty()) scene_.confidences.resize(kConfidenceSteps + 1);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] > 1) continue;
    const bool removed = mask[i] != 0;
    const std::uint8_t steps = confidence.empty() ? 0 : static_cast<std::uint8_t>(confidence[i]);
    if (!confidence.empty()) ++scene_.confidences[steps];
    ++scene_.points_in_range;
    ++(removed ? scene_.counts[0].true_positive : scene_.counts[0].kept_static);
    const std::array<std::uint8_t, 2> verdict = {mask[i], steps};
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[i].cast<double>();
    const ShownPoint shown{map_steps(scene_.T_upright_world * world), number,
                           removed ? kRemovedId : kKeptId};
    const std::uint64_t group = removed ? number + 1 : steps >= kUncertainSteps ? 1 : 0;
    (removed ? removed_ : kept_).add(shown, group, verdict);
  }
}

Scene MapSceneBuilder::finish() {
  kept_.reduce(limit_ - removed_.size());
  // A page's coordinates must tell cells apart.
  std::vector<ShownPoint> all = removed_.points();
  all.insert(all.end(), kept_.points().begin(), kept_.points().end());
  const int unit = 1 << page_frame(all, scene_.shift).shift;
  removed_.align(unit);
  kept_.align(unit);
  scene_.review.removed_cell = scene_.error_cell = removed_.cell();
  scene_.review.kept_cell = scene_.other_cell = kept_.cell();
  gather_points(removed_, kept_, scene_);
  return std::move(scene_);
}

}  // namespace raymoval
