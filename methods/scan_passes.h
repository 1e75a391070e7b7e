// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>

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

}  // namespace raymoval
