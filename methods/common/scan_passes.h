// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "methods/remover.h"

namespace raymoval {

enum class ScanOrder { kForward, kBackward };

/// One pass: calls `visit(Scan)` with each scan, one after the other; shows progress, stops when
/// asked to and books the time of the visit, without loading, to the scan.
/// @param what names the pass in progress lines
template <class Visit>
void for_each_scan(const char* what, const ScanSource& scans, const RunContext& context,
                   Visit&& visit, ScanOrder order = ScanOrder::kForward) {
  context.begin_pass(what, scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    context.check_cancelled();
    const std::size_t index = order == ScanOrder::kForward ? i : scans.size() - 1 - i;
    Scan scan = scans.load(index);
    const ScanScope timed(context.times, index);
    visit(std::move(scan));
    context.advance();
  }
}

/// One pass of visits that know nothing of each other: as many scans at a time as there are
/// threads, each visited on one of them. The time is booked to the scans in equal parts and, with
/// several threads, to `stage`, since what goes on side by side within a visit cannot be told
/// apart.
template <class Visit>
void for_scans_at_once(const char* what, const char* stage, const ScanSource& scans,
                       const RunContext& context, Visit&& visit) {
  context.begin_pass(what, scans.size());
  const auto width = static_cast<std::size_t>(std::clamp(context.threads, 1, 64));
  std::vector<Scan> batch(std::min(width, scans.size()));
  for (std::size_t first = 0; first < scans.size(); first += width) {
    const std::size_t count = std::min(width, scans.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      context.check_cancelled();
      batch[i] = scans.load(first + i);
    }
    const auto started = std::chrono::steady_clock::now();
    {
      const StageScope timed(width > 1 ? context.times : nullptr, stage);
      parallel_for(context.threads, count, 1, [&](std::size_t i) { visit(batch[i]); });
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
    for (std::size_t i = 0; i < count; ++i) {
      if (context.times != nullptr) {
        context.times->add_scan(first + i, wall.count() / static_cast<double>(count));
      }
      context.advance();
    }
  }
}

}  // namespace raymoval
