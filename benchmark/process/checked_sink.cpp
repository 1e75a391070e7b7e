// SPDX-License-Identifier: MIT
#include "benchmark/process/checked_sink.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// @param of "method 'x', scan 3", for messages
/// @param what was given, for messages
/// @throws MethodError for an unknown scan, or if there is not one value for each of its points
void check_values(const std::string& of, const char* what, const TimedSource& scans,
                  std::size_t scan, std::size_t values) {
  if (scan >= scans.size()) {
    throw MethodError(
        fmt::format("{}: there are only {} scans, counted from 0.", of, scans.size()));
  }
  const std::size_t points = scans.point_count(scan);
  if (values == points) return;
  throw MethodError(
      fmt::format("{}: the {} has {} values, expected one for each of the scan's {} points.", of,
                  what, grouped_text(values), grouped_text(points)));
}

/// @param kept `MaskStore` or `ScanSpool`
/// @throws MethodError that names the first scan without a piece
template <class Store>
void check_complete(const std::string& method, const char* what, const Store& kept) {
  for (std::size_t scan = 0; scan < kept.size(); ++scan) {
    if (kept.has(scan)) continue;
    throw MethodError(
        fmt::format("method '{}' gave no {} for scan {} of {}, expected one for each.", method,
                    what, scan, kept.size()));
  }
}

[[noreturn]] void throw_given_twice(const std::string& of) {
  throw MethodError(of + ": answered a second time, expected once.");
}

}  // namespace

Scan TimedSource::load(std::size_t index) const {
  if (rule_) {
    const std::lock_guard lock(mutex_);
    if (index < times_.size() && times_[index]) {
      throw MethodError(fmt::format(
          "method '{}' is marked online and reads scan {} a second time; an online method reads "
          "each scan once. Keep its points in the method, or mark the variant as offline.",
          rule_->method, index));
    }
  }
  const auto started = std::chrono::steady_clock::now();
  Scan scan = source_.load(index);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  const std::lock_guard lock(mutex_);
  if (std::this_thread::get_id() == owner_) waited_ += elapsed.count();
  counts_[index] = scan.size();
  times_[index] = scan.time_s;
  end_ = std::max(end_, index + 1);
  return scan;
}

void TimedSource::check_in_time(std::size_t index) const {
  if (!rule_) return;
  const std::lock_guard lock(mutex_);
  const bool waits = rule_->delay_s > 0.0;
  const double last = times_[index].value_or(0.0) + rule_->delay_s;
  std::size_t later = 0, latest = index;
  for (std::size_t i = index + 1; i < end_; ++i) {
    if (!times_[i] || (waits && *times_[i] <= last)) continue;
    ++later;
    latest = i;
  }
  const std::size_t at_once = rule_->threads > 1 ? 2 * static_cast<std::size_t>(rule_->threads) : 1;
  if (later + (waits ? 0 : 1) <= at_once)
    return;  // With a delay, the first later scan only shows that the delay is over.
  throw MethodError(fmt::format(
      "method '{}' is marked online and answers for scan {} after it has read scan {}; expected "
      "the answer from the scans up to it{}. Answer earlier, or mark the variant as offline.",
      rule_->method, index, latest,
      waits ? fmt::format(" and those of the {} s after it", rule_->delay_s) : ""));
}

double TimedSource::waited_seconds() const {
  const std::lock_guard lock(mutex_);
  return waited_;
}

std::size_t TimedSource::point_count(std::size_t index) const {
  {
    const std::lock_guard lock(mutex_);
    if (counts_[index]) return *counts_[index];
  }
  const std::size_t count = source_.load(index).size();
  const std::lock_guard lock(mutex_);
  counts_[index] = count;
  return count;
}

void CheckedSink::accept(std::size_t scan, const Mask& mask) {
  const std::string of = fmt::format("method '{}', scan {}", method_, scan);
  check_values(of, "mask", scans_, scan, mask.size());
  if (std::any_of(mask.begin(), mask.end(), [](std::uint8_t value) { return value > 1; })) {
    throw MethodError(of + ": a mask value is neither 0 (kept) nor 1 (removed).");
  }
  scans_.check_in_time(scan);
  const std::lock_guard lock(mutex_);
  if (masks_.has(scan)) throw_given_twice(of);
  masks_.set(scan, mask);
}

MaskStore CheckedSink::finish() {
  check_complete(method_, "mask", masks_);
  return std::move(masks_);
}

void CheckedReasons::explain(const std::vector<std::string>& sentences) {
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

void CheckedReasons::accept(std::size_t scan, const std::vector<std::uint8_t>& codes) {
  const std::string of = fmt::format("method '{}', reasons of scan {}", method_, scan);
  check_values(of, "list of codes", scans_, scan, codes.size());
  const std::lock_guard lock(mutex_);
  const std::size_t end = reasons_.sentences.size();
  if (end == 0) throw MethodError(of + ": they came before their sentences.");
  if (std::any_of(codes.begin(), codes.end(), [&](std::uint8_t code) { return code >= end; })) {
    throw MethodError(of + ": a code has no sentence.");
  }
  reasons_.codes[scan] = codes;
}

void CheckedConfidence::accept(std::size_t scan, std::span<const float> evidence) {
  const std::string of = fmt::format("method '{}', evidence of scan {}", method_, scan);
  check_values(of, "evidence", scans_, scan, evidence.size());
  std::string steps(evidence.size(), '\0');
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool is_fit = evidence[i] >= 0.0F && evidence[i] <= 1.0F;  // NaN is not.
    if (!is_fit) throw MethodError(of + ": a value is not from 0 to 1.");
    steps[i] = static_cast<char>(confidence_steps(calibration_.confidence(evidence[i])));
  }
  const std::lock_guard lock(mutex_);
  if (kept_.steps.has(scan)) throw_given_twice(of);
  kept_.steps.put(scan, std::move(steps));
}

ConfidenceStore CheckedConfidence::finish() {
  check_complete(method_, "evidence", kept_.steps);
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
