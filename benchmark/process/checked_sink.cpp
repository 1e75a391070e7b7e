// SPDX-License-Identifier: MIT
#include "benchmark/process/checked_sink.h"

#include <algorithm>

#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::string place(const std::string& method, std::size_t scan) {
  return "method '" + method + "', scan " + std::to_string(scan) + ": ";
}

}  // namespace

void check_answer(const std::string& method, const TimedSource& scans, std::size_t scan,
                  const Mask& mask) {
  const std::string who = place(method, scan);
  if (scan >= scans.size()) {
    throw MethodError(who + "there are only " + std::to_string(scans.size()) +
                      " scans, counted from 0.");
  }
  const std::size_t points = scans.point_count(scan);
  if (mask.size() != points) {
    throw MethodError(who + "the mask has " + grouped_text(mask.size()) +
                      " values, expected one for each of the scan's " + grouped_text(points) +
                      " points.");
  }
  if (std::any_of(mask.begin(), mask.end(), [](std::uint8_t value) { return value > 1; })) {
    throw MethodError(who + "a mask value is neither 0 (kept) nor 1 (removed).");
  }
}

void throw_second_answer(const std::string& method, std::size_t scan) {
  throw MethodError(place(method, scan) + "answered a second time, expected once.");
}

void throw_missing_answer(const std::string& method, std::size_t scan, std::size_t scans) {
  throw MethodError("method '" + method + "' gave no mask for scan " + std::to_string(scan) +
                    " of " + std::to_string(scans) + ", expected one for each.");
}

void CheckedSink::accept(std::size_t scan, const Mask& mask) {
  check_answer(method_, scans_, scan, mask);
  const std::lock_guard lock(mutex_);
  if (masks_.has(scan)) throw_second_answer(method_, scan);
  masks_.set(scan, mask);
}

const MaskStore& CheckedSink::finish() const {
  for (std::size_t scan = 0; scan < masks_.size(); ++scan) {
    if (!masks_.has(scan)) throw_missing_answer(method_, scan, masks_.size());
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
