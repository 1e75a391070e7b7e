// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

namespace raymoval::simulated {

/// A cache of the last values by scan, so that a scan and its labels are generated once.
/// Thread-safe.
template <class Value>
class LastValues {
 public:
  /// @param most number of kept values
  explicit LastValues(std::size_t most) : most_(most) {}

  /// The value of a scan; null if it is not kept.
  [[nodiscard]] std::shared_ptr<const Value> find(std::size_t scan) const {
    const std::lock_guard lock(mutex_);
    for (const auto& [known, value] : kept_) {
      if (known == scan) return value;
    }
    return nullptr;
  }

  std::shared_ptr<const Value> keep(std::size_t scan, Value value) {
    const auto made = std::make_shared<const Value>(std::move(value));
    const std::lock_guard lock(mutex_);
    kept_.emplace_front(scan, made);
    if (kept_.size() > most_) kept_.pop_back();
    return made;
  }

 private:
  std::size_t most_;
  mutable std::mutex mutex_;
  std::deque<std::pair<std::size_t, std::shared_ptr<const Value>>> kept_;  ///< The last in front.
};

}  // namespace raymoval::simulated
