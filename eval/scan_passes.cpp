// SPDX-License-Identifier: MIT
#include "eval/scan_passes.h"

#include <malloc.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>

#include "core/error.h"
#include "core/parallel.h"
#include "eval/checked_scan.h"

namespace raymoval {
namespace {

/// One pass over the scans by several workers. Scans are assigned in order, and their results are
/// taken in the same order, each by any free worker.
class OrderedPass {
 public:
  OrderedPass(const EvaluationInput& input, std::size_t slots,
              const std::function<void(std::size_t, std::size_t)>& read,
              const std::function<void(std::size_t)>& take)
      : input_(input), scans_(input.scans->size()), read_(read), take_(take), ready_(slots, 0) {}

  void run() {
    const auto workers = static_cast<std::size_t>(std::max(1, input_.threads));
    parallel_for(input_.threads, std::min(workers, scans_), 1, [this](std::size_t) { work(); });
    if (error_) std::rethrow_exception(error_);
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  void work() {
    for (std::size_t scan = next(); scan < scans_; scan = next()) {
      try {
        throw_if_cancelled(input_.cancel);
        read_(scan, scan % ready_.size());
        if (input_.progress != nullptr) input_.progress->advance();
        process_ready(scan);
      } catch (...) {
        keep_error(scan);
      }
    }
  }

  /// The next scan to read, once a slot is free for it; the number of scans if there is none.
  std::size_t next() {
    Lock lock(mutex_);
    if (error_ || handed_out_ == scans_) return scans_;
    const std::size_t scan = handed_out_++;
    slot_is_free_.wait(lock, [&] { return error_ || scan < taken_ + ready_.size(); });
    return error_ ? scans_ : scan;
  }

  /// Takes the scans that are next, unless another worker is doing so.
  void process_ready(std::size_t read_scan) {
    Lock lock(mutex_);
    ready_[read_scan % ready_.size()] = 1;
    if (is_taking_) return;
    is_taking_ = true;
    while (!error_ && taken_ < scans_ && ready_[taken_ % ready_.size()] != 0) {
      const std::size_t slot = taken_ % ready_.size();
      lock.unlock();
      take_(slot);
      lock.lock();
      ready_[slot] = 0;
      ++taken_;
      slot_is_free_.notify_all();
    }
    is_taking_ = false;
  }

  /// Ends the pass. Of several errors that of the first scan is kept.
  void keep_error(std::size_t scan) {
    const Lock lock(mutex_);
    if (!error_ || scan < error_scan_) {
      error_ = std::current_exception();
      error_scan_ = scan;
    }
    slot_is_free_.notify_all();
  }

  const EvaluationInput& input_;
  const std::size_t scans_;
  const std::function<void(std::size_t, std::size_t)>& read_;
  const std::function<void(std::size_t)>& take_;

  std::mutex mutex_;
  std::condition_variable slot_is_free_;
  std::size_t handed_out_ = 0, taken_ = 0;
  std::vector<char> ready_;  ///< For each slot whether its scan waits to be taken.
  bool is_taking_ = false;
  std::exception_ptr error_;
  std::size_t error_scan_ = 0;
};

/// The visitors of the next pass: all visitors that do not wait for others, or else the first that
/// waits. Visitors that need no further pass are removed from `visitors`.
std::vector<ScanVisitor*> begin_next_pass(std::vector<ScanVisitor*>& visitors, std::size_t slots) {
  std::vector<ScanVisitor*> shown;
  const auto needs_no_pass = [&](ScanVisitor* visitor) {
    const bool needs_pass = visitor->begin_pass(slots);
    if (needs_pass) shown.push_back(visitor);
    return !needs_pass;
  };
  std::erase_if(visitors, [&](ScanVisitor* visitor) {
    return !visitor->runs_last() && needs_no_pass(visitor);
  });
  while (shown.empty() && !visitors.empty()) {
    if (needs_no_pass(visitors.front())) visitors.erase(visitors.begin());
  }
  return shown;
}

void run_all(const EvaluationInput& input, const MaskStore* masks, const std::string& task,
             std::vector<ScanVisitor*> visitors) {
  const std::size_t slots = usual_slots(input);
  for (int pass = 1;; ++pass) {
    const std::vector<ScanVisitor*> shown = begin_next_pass(visitors, slots);
    if (shown.empty()) return;
    const std::string name = pass == 1 ? task : task + ", pass " + std::to_string(pass);
    in_scan_order(
        input, name, slots,
        [&](std::size_t index, std::size_t slot) {
          const CheckedScan scan = load_checked(input, masks, index);
          for (ScanVisitor* visitor : shown) visitor->read(scan, slot);
        },
        [&](std::size_t slot) {
          for (ScanVisitor* visitor : shown) visitor->take(slot);
        });
    // Returns memory of small pieces to the system before the next tables are allocated.
    (void)malloc_trim(0);
  }
}

}  // namespace

void in_scan_order(const EvaluationInput& input, const std::string& task, std::size_t slots,
                   const std::function<void(std::size_t, std::size_t)>& read,
                   const std::function<void(std::size_t)>& take) {
  if (input.progress != nullptr) input.progress->begin(task, input.scans->size());
  OrderedPass(input, slots, read, take).run();
  if (input.progress != nullptr) input.progress->end();
}

std::size_t usual_slots(const EvaluationInput& input) {
  return 2 * static_cast<std::size_t>(std::max(1, input.threads));
}

void run_passes(const EvaluationInput& input, const MaskStore& masks,
                std::vector<ScanVisitor*> visitors) {
  check_mask_count(input, masks);
  run_all(input, &masks, "scoring", std::move(visitors));
}

void run_passes(const EvaluationInput& input, const std::string& task,
                std::vector<ScanVisitor*> visitors) {
  run_all(input, nullptr, task, std::move(visitors));
}

}  // namespace raymoval
