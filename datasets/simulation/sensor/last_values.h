// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

namespace raymoval::simulated {

/// What was made last for some scans, so that asking for a scan and then for its labels makes it
/// once. Thread-safe.
template <class Value>
class LastValues {
 public:
  /// @param most values that are kept
  explicit LastValues(std::size_t most) : most_(most) {}

  /// Null if it is not kept.
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
