// SPDX-License-Identifier: MIT
#include "benchmark/report/scene.h"

#include <algorithm>
#include <map>

#include "benchmark/report/scene_points.h"
#include "benchmark/result/removals/reasons.h"
#include "core/scan/local_frame.h"
#include "eval/columns/removal_tally.h"

namespace raymoval {
namespace {

/// The share of the points that may be wrongly classified ones.
constexpr double kErrorShare = 0.6;

/// What a method did to one scan.
struct ScanVerdicts {
  Mask removed;
  std::vector<std::uint8_t> reasons;  ///< Empty if there are none.

  [[nodiscard]] std::uint8_t byte(std::size_t point) const {
    const int reason = reasons.empty() ? 0 : reasons[point] + 1;
    return static_cast<std::uint8_t>(removed[point] | reason << 1);
  }
};

/// Reads a sequence scan by scan and chooses what is shown.
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
    const ShownPoint shown{steps_of(scan.T_world_sensor * scan.points[point].cast<double>()),
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
  std::vector<std::uint8_t> bytes_;  ///< What each cell did to the present point.
  std::map<std::uint16_t, LabelClass> labels_;
  bool only_controls_ = false;
  Scene scene_;
};

}  // namespace

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

}  // namespace raymoval
