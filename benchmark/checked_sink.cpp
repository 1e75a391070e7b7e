// SPDX-License-Identifier: MIT
#include "benchmark/checked_sink.h"

#include <algorithm>

#include "core/files.h"
#include "core/text.h"

namespace raymoval {

void CheckedSink::accept(std::size_t scan, const Mask& mask) {
  const std::string who = "method '" + method_ + "', scan " + std::to_string(scan) + ": ";
  if (scan >= scans_.size()) {
    throw MethodError(who + "there are only " + std::to_string(scans_.size()) +
                      " scans, counted from 0.");
  }
  const std::size_t points = scans_.point_count(scan);
  if (mask.size() != points) {
    throw MethodError(who + "the mask has " + grouped_text(mask.size()) +
                      " values, expected one for each of the scan's " + grouped_text(points) +
                      " points.");
  }
  if (std::any_of(mask.begin(), mask.end(), [](std::uint8_t value) { return value > 1; })) {
    throw MethodError(who + "a mask value is neither 0 (kept) nor 1 (removed).");
  }
  const std::lock_guard lock(mutex_);
  if (masks_.has(scan)) throw MethodError(who + "answered a second time, expected once.");
  masks_.set(scan, mask);
}

const MaskStore& CheckedSink::finish() const {
  for (std::size_t scan = 0; scan < masks_.size(); ++scan) {
    if (!masks_.has(scan)) {
      throw MethodError("method '" + method_ + "' gave no mask for scan " + std::to_string(scan) +
                        " of " + std::to_string(masks_.size()) + ", expected one for each.");
    }
  }
  return masks_;
}

std::string mask_digest(const MaskStore& masks) {
  ContentHasher hasher;
  for (std::size_t scan = 0; scan < masks.size(); ++scan) {
    const Mask mask = masks.get(scan);
    hasher.add(std::to_string(mask.size()) + ":");
    hasher.add(mask.data(), mask.size());
  }
  return hasher.digest();
}

}  // namespace raymoval
