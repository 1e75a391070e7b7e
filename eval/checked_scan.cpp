// SPDX-License-Identifier: MIT
#include "eval/checked_scan.h"

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

Mask checked_mask(const MaskStore& masks, const Scan& scan, std::size_t index) {
  if (index >= masks.size() || !masks.has(index)) {
    throw MethodError("scan " + std::to_string(index) + " (" + scan.name +
                      ") has no mask: expected one per scan. The method must answer for every "
                      "scan, also for an empty one.");
  }
  Mask mask = masks.get(index);
  if (mask.size() != scan.size()) {
    throw MethodError("scan " + std::to_string(index) + " (" + scan.name + "): its mask has " +
                      grouped_text(mask.size()) + " values and the scan " +
                      grouped_text(scan.size()) +
                      " points; expected as many. Were the masks made from the same data?");
  }
  return mask;
}

std::vector<std::uint32_t> checked_labels(const LabelSource& source, const Scan& scan,
                                          std::size_t index) {
  std::vector<std::uint32_t> labels = source.labels(scan);
  if (labels.size() != scan.size()) {
    throw DataError("scan " + std::to_string(index) + " (" + scan.name + "): " +
                    grouped_text(labels.size()) + " labels for " + grouped_text(scan.size()) +
                    " points; expected as many. Check that labels and scans belong together.");
  }
  return labels;
}

}  // namespace

CheckedScan load_checked(const EvaluationInput& input, const MaskStore* masks, std::size_t index) {
  CheckedScan loaded;
  loaded.scan = input.scans->load(index);
  loaded.labels = checked_labels(*input.labels, loaded.scan, index);
  if (masks != nullptr) loaded.mask = checked_mask(*masks, loaded.scan, index);
  return loaded;
}

void throw_changed(const EvaluationInput& input, std::size_t index) {
  throw DataError(
      "scan " + std::to_string(index) + " (" + input.scans->load(index).name +
      ") has a point where there was none when the protocol was opened: the data changed "
      "while it was used. Run again when nothing writes to the data any more.");
}

void check_mask_count(const EvaluationInput& input, const MaskStore& masks) {
  if (masks.size() == input.scans->size()) return;
  throw MethodError(std::to_string(masks.size()) + " masks for " +
                    std::to_string(input.scans->size()) + " scans; expected one per scan.");
}

}  // namespace raymoval
