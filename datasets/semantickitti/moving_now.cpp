// SPDX-License-Identifier: MIT
#include "datasets/semantickitti/moving_now.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/files/fields.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"

namespace raymoval {
namespace {

/// The label of what stands for that of what moves; the id itself for one that says no motion.
std::uint16_t standing_id(std::uint16_t id) {
  static const std::map<std::uint16_t, std::uint16_t> ids = {
      {252, 10}, {253, 31}, {254, 30}, {255, 32}, {256, 16}, {257, 13}, {258, 18}, {259, 20}};
  const auto found = ids.find(id);
  return found == ids.end() ? id : found->second;
}

/// From which frame on something moves, or does not.
struct Change {
  long frame = 0;
  bool moves = false;
};
/// By instance, in order of frames.
using Motions = std::map<std::uint16_t, std::vector<Change>>;

std::vector<Change> changes_of(const Fields& mover) {
  constexpr int kMostFrames = 100'000'000;
  std::vector<Change> changes;
  for (const auto& [item, where] : mover.list("when")) {
    const Fields change(*item, where, "scan time_s state at");
    (void)change.member("scan");
    const int frame = change.integer("scan", 0, 0, kMostFrames);
    if (!changes.empty() && frame <= changes.back().frame) {
      change.fail("scan", "a later scan than that of the change before");
    }
    changes.push_back({frame, change.choice("state", "", {"moves", "stands", "away"}) == "moves"});
  }
  return changes;
}

Motions read_motions(const std::filesystem::path& file) {
  if (!has_file(file)) {
    throw DataError(file.string() +
                    ": is missing; it says who moves when, which --label-rule moving-now needs. "
                    "Simulated scenes have it. Labels of other data say only what moves at any "
                    "time: leave the rule out.");
  }
  const nlohmann::json whole = {{"movers", read_json(file)}};
  const Fields list(whole, file.string(), "movers");
  Motions motions;
  for (const auto& [item, where] : list.list("movers")) {
    const Fields mover(*item, where, "instance label kind moves when");
    (void)mover.member("instance");
    const auto instance = static_cast<std::uint16_t>(mover.integer("instance", 0, 0, 0xFFFF));
    if (!motions.emplace(instance, changes_of(mover)).second) {
      mover.fail("instance", "one that no other mover has");
    }
  }
  return motions;
}

class MovingNowLabels : public LabelSource {
 public:
  MovingNowLabels(std::shared_ptr<const LabelSource> labels, Motions motions,
                  std::vector<long> frames)
      : labels_(std::move(labels)), motions_(std::move(motions)), frames_(std::move(frames)) {}

  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    std::vector<std::uint32_t> words = labels_->labels(scan);
    const std::vector<std::uint8_t> stands = standing(frames_.at(scan.index));
    for (std::uint32_t& word : words) {
      if (stands[word >> 16U] != 0) word = (word & 0xFFFF0000U) | standing_id(semantic_id(word));
    }
    return words;
  }

 private:
  /// For each instance whether it does not move in a frame.
  [[nodiscard]] std::vector<std::uint8_t> standing(long frame) const {
    std::vector<std::uint8_t> stands(0x10000, 0);
    for (const auto& [instance, changes] : motions_) {
      const auto next =
          std::upper_bound(changes.begin(), changes.end(), frame,
                           [](long at, const Change& change) { return at < change.frame; });
      if (next != changes.begin() && !(next - 1)->moves) stands[instance] = 1;
    }
    return stands;
  }

  std::shared_ptr<const LabelSource> labels_;
  Motions motions_;
  std::vector<long> frames_;
};

}  // namespace

std::shared_ptr<const LabelSource> moving_now_labels(std::shared_ptr<const LabelSource> labels,
                                                     const std::filesystem::path& file,
                                                     std::vector<long> frames) {
  return std::make_shared<MovingNowLabels>(std::move(labels), read_motions(file),
                                           std::move(frames));
}

}  // namespace raymoval
