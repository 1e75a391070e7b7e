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

void ReasonStore::explain(const std::vector<std::string>& sentences) {
  const std::lock_guard lock(mutex_);
  if (!reasons_.sentences.empty()) {
    throw MethodError("method '" + method_ + "' named its reasons twice, expected once.");
  }
  constexpr std::size_t kMost = 127;
  if (sentences.empty() || sentences.size() > kMost) {
    throw MethodError("method '" + method_ + "' has " + std::to_string(sentences.size()) +
                      " reasons, expected 1 to 127.");
  }
  reasons_.sentences = sentences;
  reasons_.codes.resize(scans_.size());
}

void ReasonStore::accept(std::size_t scan, const std::vector<std::uint8_t>& codes) {
  const std::lock_guard lock(mutex_);
  const std::string who = "method '" + method_ + "', reasons of scan " + std::to_string(scan);
  if (scan >= reasons_.codes.size()) {
    throw MethodError(who + ": there is no such scan, or they came before their sentences.");
  }
  if (codes.size() != scans_.point_count(scan)) {
    throw MethodError(who + ": there are " + grouped_text(codes.size()) +
                      ", expected one for each of the scan's " +
                      grouped_text(scans_.point_count(scan)) + " points.");
  }
  const std::size_t end = reasons_.sentences.size();
  if (std::any_of(codes.begin(), codes.end(), [&](std::uint8_t code) { return code >= end; })) {
    throw MethodError(who + ": a code has no sentence.");
  }
  reasons_.codes[scan] = codes;
}

Reasons ReasonStore::finish() {
  return std::move(reasons_);
}

void CheckedConfidence::accept(std::size_t scan, std::span<const float> evidence) {
  const std::string who = "method '" + method_ + "', evidence of scan " + std::to_string(scan);
  if (scan >= scans_.size()) {
    throw MethodError(who + ": there are only " + std::to_string(scans_.size()) +
                      " scans, counted from 0.");
  }
  if (evidence.size() != scans_.point_count(scan)) {
    throw MethodError(who + ": there are " + grouped_text(evidence.size()) +
                      " values, expected one for each of the scan's " +
                      grouped_text(scans_.point_count(scan)) + " points.");
  }
  std::string steps(evidence.size(), '\0');
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool is_fit = evidence[i] >= 0.0F && evidence[i] <= 1.0F;  // NaN is not.
    if (!is_fit) throw MethodError(who + ": a value is not from 0 to 1.");
    steps[i] = static_cast<char>(confidence_steps(calibration_.confidence(evidence[i])));
  }
  const std::lock_guard lock(mutex_);
  if (is_filled_[scan] != 0) throw MethodError(who + " was given a second time, expected once.");
  is_filled_[scan] = 1;
  keep(scan, std::move(steps));
}

void CheckedConfidence::check_complete() const {
  const auto missing = std::find(is_filled_.begin(), is_filled_.end(), 0);
  if (missing == is_filled_.end()) return;
  throw MethodError("method '" + method_ + "' gave no evidence for scan " +
                    std::to_string(missing - is_filled_.begin()) + " of " +
                    std::to_string(is_filled_.size()) + ", expected one for each.");
}

ConfidenceStore KeptConfidence::finish() {
  check_complete();
  return std::move(kept_);
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
