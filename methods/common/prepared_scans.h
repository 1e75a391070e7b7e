// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "methods/common/scan_passes.h"

namespace raymoval {

/// The context of a step if several scans are processed at once: one thread, and no times, because
/// the stages of parallel steps cannot be separated.
inline RunContext for_one_of_many(const RunContext& context) {
  RunContext one = context;
  if (context.threads > 1) one.times = nullptr;
  one.threads = 1;
  return one;
}

/// One pass: `prepare(Scan, Work&, context)` computes what does not depend on other scans, on any
/// thread, and `commit(Work&, context)` uses the results in order of the scans. With several
/// threads, scans are prepared while earlier ones are committed, and the time is booked to `stage`.
template <class Work, class Prepare, class Commit>
void for_prepared_scans(const char* what, const char* stage, const ScanSource& scans,
                        const RunContext& context, Prepare&& prepare, Commit&& commit) {
  if (context.threads <= 1) {
    Work work;
    for_each_scan(what, scans, context, [&](Scan scan) {
      prepare(std::move(scan), work, context);
      commit(work, context);
    });
    return;
  }
  const RunContext one = for_one_of_many(context);
  std::vector<Work> next(scans_in_a_batch(scans, context)), ready(next.size());
  std::size_t ready_count = 0;
  const auto commit_all = [&] {
    for (std::size_t i = 0; i < ready_count; ++i) commit(ready[i], one);
  };
  for_scan_batches(what, scans, context, [&](std::span<Scan> batch) {
    const StageScope timed(context.times, stage);
    parallel_for(context.threads, 1 + batch.size(), 1, [&](std::size_t task) {
      if (task == 0) {
        commit_all();
      } else {
        prepare(std::move(batch[task - 1]), next[task - 1], one);
      }
    });
    std::swap(next, ready);
    ready_count = batch.size();
  });
  const StageScope timed(context.times, stage);
  commit_all();
}

}  // namespace raymoval
