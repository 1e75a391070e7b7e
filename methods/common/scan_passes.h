// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "methods/remover.h"

namespace raymoval {

/// The scans of a source in a pass, first to last.
struct ScanSelection {
  std::size_t first = 0;
  std::size_t count = 0;
  std::size_t step = 1;  ///< From a scan's number to the next one's.

  [[nodiscard]] std::size_t size() const { return count; }
  [[nodiscard]] std::size_t operator[](std::size_t i) const { return first + i * step; }
};

inline ScanSelection all_scans(const ScanSource& scans) {
  return {0, scans.size(), 1};
}

/// The scans first, first + step, ... below `end`.
inline ScanSelection every_nth_scan(std::size_t first, std::size_t end, std::size_t step) {
  return {first, end > first ? (end - first - 1) / step + 1 : 0, step};
}

/// One pass: calls `visit(Scan)` with each selected scan, one after the other. It shows progress,
/// stops on a cancel, and books the time of the visit, without loading, to the scan.
/// @param what names the pass in progress lines
/// @param selection a `ScanSelection`, or a vector of scans' numbers
template <class Selection, class Visit>
void for_each_scan(const char* what, const ScanSource& scans, const Selection& selection,
                   const RunContext& context, Visit&& visit) {
  context.begin_pass(what, selection.size());
  for (std::size_t i = 0; i < selection.size(); ++i) {
    context.check_cancelled();
    Scan scan = scans.load(selection[i]);
    const ScanScope timed(context.times, selection[i]);
    visit(std::move(scan));
    context.advance();
  }
}

/// The same with all scans, first to last.
template <class Visit>
void for_each_scan(const char* what, const ScanSource& scans, const RunContext& context,
                   Visit&& visit) {
  for_each_scan(what, scans, all_scans(scans), context, visit);
}

/// One pass in which every thread loads and visits chunks of `grain` consecutive scans.
/// `visit_chunk(each_scan)` is called for each chunk; it prepares the chunk and calls
/// `each_scan(visit)` once, which calls `visit(Scan)` with the scans of the chunk in turn. Visits
/// must not depend on other chunks. The time of each visit, without loading, is booked to its scan;
/// stages add up over the threads.
template <class VisitChunk>
void for_scan_chunks(const char* what, const ScanSource& scans, const ScanSelection& selection,
                     std::size_t grain, const RunContext& context, VisitChunk&& visit_chunk) {
  context.begin_pass(what, selection.count);
  parallel_chunks(context.threads, selection.count, grain, [&](std::size_t begin, std::size_t end) {
    visit_chunk([&](auto&& visit) {
      for (std::size_t i = begin; i < end; ++i) {
        context.check_cancelled();
        Scan scan = scans.load(selection[i]);
        const ScanScope timed(context.times, selection[i]);
        visit(std::move(scan));
        context.advance();
      }
    });
  });
}

/// The same for independent visits: `visit(Scan)`, on any thread.
template <class Visit>
void for_scans_in_parallel(const char* what, const ScanSource& scans,
                           const ScanSelection& selection, const RunContext& context,
                           Visit&& visit) {
  for_scan_chunks(what, scans, selection, 1, context, [&](auto&& each_scan) { each_scan(visit); });
}

/// The number of scans in a batch of `for_scan_batches`: one for each thread.
inline std::size_t scans_in_a_batch(const ScanSource& scans, const RunContext& context) {
  return std::min(static_cast<std::size_t>(std::clamp(context.threads, 1, 64)), scans.size());
}

/// One pass in batches: loads as many of the selected scans at a time as there are threads and
/// calls `visit_batch(std::span<Scan>)`. The time of a batch, without loading, is booked to its
/// scans in equal parts.
/// @param selection a `ScanSelection`, or a vector of scans' numbers
template <class Selection, class VisitBatch>
void for_scan_batches(const char* what, const ScanSource& scans, const Selection& selection,
                      const RunContext& context, VisitBatch&& visit_batch) {
  context.begin_pass(what, selection.size());
  std::vector<Scan> batch(scans_in_a_batch(scans, context));
  for (std::size_t first = 0; first < selection.size(); first += batch.size()) {
    const std::size_t count = std::min(batch.size(), selection.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      context.check_cancelled();
      batch[i] = scans.load(selection[first + i]);
    }
    const auto started = std::chrono::steady_clock::now();
    visit_batch(std::span(batch).first(count));
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
    for (std::size_t i = 0; i < count; ++i) {
      if (context.times != nullptr) {
        context.times->add_scan(selection[first + i], wall.count() / static_cast<double>(count));
      }
      context.advance();
    }
  }
}

/// The same with all scans, first to last.
template <class VisitBatch>
void for_scan_batches(const char* what, const ScanSource& scans, const RunContext& context,
                      VisitBatch&& visit_batch) {
  for_scan_batches(what, scans, all_scans(scans), context, visit_batch);
}

/// One pass in batches of independent visits: `visit(Scan&)`, each on one thread. With several
/// threads the time is also booked to `stage`, because the stages of parallel visits cannot be
/// separated.
template <class Selection, class Visit>
void for_scans_at_once(const char* what, const char* stage, const ScanSource& scans,
                       const Selection& selection, const RunContext& context, Visit&& visit) {
  for_scan_batches(what, scans, selection, context, [&](std::span<Scan> batch) {
    const StageScope timed(context.threads > 1 ? context.times : nullptr, stage);
    parallel_for(context.threads, batch.size(), 1, [&](std::size_t i) { visit(batch[i]); });
  });
}

/// The same with all scans, first to last.
template <class Visit>
void for_scans_at_once(const char* what, const char* stage, const ScanSource& scans,
                       const RunContext& context, Visit&& visit) {
  for_scans_at_once(what, stage, scans, all_scans(scans), context, visit);
}

}  // namespace raymoval
