// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/scan/mask_store.h"
#include "eval/protocol.h"

namespace raymoval {

/// Calls `read(scan, slot)` for each scan on the input's threads, and `take(slot)` with the same
/// slot afterwards: in the order of the scans, by one thread at a time, while others go on reading.
/// Below `slots` scans are in work at a time.
/// @param task shown as progress
/// @throws Cancelled; else the error of the first scan that has one
void in_scan_order(const EvaluationInput& input, const std::string& task, std::size_t slots,
                   const std::function<void(std::size_t scan, std::size_t slot)>& read,
                   const std::function<void(std::size_t slot)>& take);

/// Number of slots that keep all of the input's threads busy.
std::size_t usual_slots(const EvaluationInput& input);

/// Shows the scans of an answer to all visitors, pass after pass, until none needs another one. A
/// scan is loaded once per pass, for all of them.
/// @throws MethodError if a mask is missing or has the wrong length
/// @throws DataError if the labels of a scan do not fit it; Cancelled
void run_passes(const EvaluationInput& input, const MaskStore& masks,
                std::vector<ScanVisitor*> visitors);

/// The same without masks: no point is removed. @param task shown as progress
void run_passes(const EvaluationInput& input, const std::string& task,
                std::vector<ScanVisitor*> visitors);

}  // namespace raymoval
