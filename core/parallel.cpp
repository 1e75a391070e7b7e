// SPDX-License-Identifier: MIT
#include "core/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#ifdef RAYMOVAL_WATCHED_THREADS
#include <sanitizer/tsan_interface.h>
#endif

namespace raymoval {

int hardware_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {

/// Keeps the exception of the lowest chunk, so that the error reported does not depend on timing.
class FirstError {
 public:
  void keep(std::size_t chunk) {
    const std::lock_guard lock(mutex_);
    if (!error_ || chunk < chunk_) {
      error_ = std::current_exception();
      chunk_ = chunk;
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
  std::size_t chunk_ = 0;
};

/// Declares TBB's ordering to ThreadSanitizer, which cannot see it: code before a loop, then its
/// chunks, then code after the loop. Chunks have no order among each other, so that a race between
/// two of them is still found. Does nothing in other builds.
class LoopOrder {
 public:
#ifdef RAYMOVAL_WATCHED_THREADS
  void loop_begins() {
    __tsan_release(&begin_);
  }
  void chunk_begins() {
    __tsan_acquire(&begin_);
  }
  void chunk_ends() {
    __tsan_release(&end_);
  }
  void loop_ends() {
    __tsan_acquire(&end_);
  }

 private:
  char begin_ = 0, end_ = 0;
#else
  static void loop_begins() {}
  static void chunk_begins() {}
  static void chunk_ends() {}
  static void loop_ends() {}
#endif
};

/// The arena that is kept from loop to loop, which finds its threads still awake when one short
/// loop follows another.
struct KeptArena {
  std::atomic_flag is_busy;
  int threads = 0;
  std::unique_ptr<tbb::task_arena> arena;
};
KeptArena& kept_arena() {
  static KeptArena& kept = *new KeptArena;  // Never destroyed: TBB may be gone before it.
  return kept;
}

/// Threads of the kept arena if the loop of this thread runs there, else 0.
thread_local int threads_around = 0;

/// Sets `threads_around` while a chunk runs.
class ChunkScope {
 public:
  explicit ChunkScope(int threads) : outer_(threads_around) { threads_around = threads; }
  ~ChunkScope() { threads_around = outer_; }
  ChunkScope(const ChunkScope&) = delete;
  ChunkScope& operator=(const ChunkScope&) = delete;

 private:
  int outer_;
};

/// Runs `work(threads of the kept arena, or 0 if it is not used)` with at most `threads` threads. A
/// loop within a loop of as many threads shares its arena, so that idle threads help. While the
/// inner loop waits for other threads, its thread takes no other work. A loop within a smaller
/// loop, or beside one, gets a separate arena.
template <class Work>
void run_in_arena(int threads, Work&& work) {
  // TBB never runs more threads than this, and warns on standard error if more are requested. It is
  // the number of processors, unless a `tbb::global_control` changes it.
  const std::size_t allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const int most = static_cast<int>(std::min(static_cast<std::size_t>(threads), allowed));
  if (threads_around == most) {
    tbb::this_task_arena::isolate([&] { work(most); });
    return;
  }
  KeptArena& kept = kept_arena();
  if (kept.is_busy.test_and_set(std::memory_order_acquire)) {
    tbb::task_arena(most).execute([&] { work(0); });
    return;
  }
  if (kept.threads != most) {
    kept.arena = std::make_unique<tbb::task_arena>(most);
    kept.threads = most;
  }
  kept.arena->execute([&] { work(most); });
  kept.is_busy.clear(std::memory_order_release);
}

}  // namespace

void parallel_chunks(int threads, std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (count + grain - 1) / grain;
  const auto run_chunk = [&](std::size_t chunk) {
    body(chunk * grain, std::min(count, (chunk + 1) * grain));
  };
  if (threads <= 1 || chunks <= 1) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) run_chunk(chunk);
    return;
  }
  FirstError first_error;
  LoopOrder order;
  order.loop_begins();
  run_in_arena(threads, [&](int threads_of_arena) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          const ChunkScope scope(threads_of_arena);
          for (std::size_t chunk = range.begin(); chunk != range.end(); ++chunk) {
            order.chunk_begins();
            try {
              run_chunk(chunk);
            } catch (...) {
              first_error.keep(chunk);
            }
            order.chunk_ends();
          }
        },
        tbb::simple_partitioner());
  });
  order.loop_ends();
  first_error.rethrow();
}

}  // namespace raymoval
