// SPDX-License-Identifier: MIT
#include "benchmark/process/timed_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"

namespace raymoval {

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

}  // namespace raymoval
