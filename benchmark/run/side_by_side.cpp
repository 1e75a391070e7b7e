// SPDX-License-Identifier: MIT
#include "benchmark/run/side_by_side.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace raymoval {
namespace {

/// What several threads take from.
class Worklist {
 public:
  Worklist(std::size_t count, const std::function<void(std::size_t)>& work)
      : count_(count), work_(work) {}

  /// Takes and does until nothing is left.
  void work_off() {
    for (std::size_t i = next_++; i < count_; i = next_++) {
      try {
        work_(i);
      } catch (...) {
        fail(i);
      }
    }
  }
  /// Nothing more is taken.
  void close() { next_ = count_; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void fail(std::size_t i) {
    close();
    const std::lock_guard lock(mutex_);
    if (error_ && failed_ < i) return;
    error_ = std::current_exception();
    failed_ = i;
  }

  std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::exception_ptr error_;
  std::size_t failed_ = 0;
};

/// Closes a list also if a thread cannot be started, so that those that run come to an end.
struct Closing {
  Worklist& list;
  ~Closing() { list.close(); }
};

}  // namespace

void run_side_by_side(int jobs, std::size_t count, const std::function<void(std::size_t)>& work) {
  Worklist list(count, work);
  {
    const std::size_t threads = std::min(static_cast<std::size_t>(std::max(jobs, 1)), count);
    std::vector<std::jthread> others;  // They are waited for at their end.
    const Closing closing{list};
    while (others.size() + 1 < threads) others.emplace_back([&] { list.work_off(); });
    list.work_off();
  }
  list.rethrow();
}

}  // namespace raymoval
