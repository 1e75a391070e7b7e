// SPDX-License-Identifier: MIT
#include "benchmark/process/timed_source.h"

#include <chrono>

namespace raymoval {

Scan TimedSource::load(std::size_t index) const {
  const auto started = std::chrono::steady_clock::now();
  Scan scan = source_.load(index);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  const std::lock_guard lock(mutex_);
  if (std::this_thread::get_id() == owner_) waited_ += elapsed.count();
  counts_[index] = scan.size();
  return scan;
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
  return load(index).size();
}

}  // namespace raymoval
