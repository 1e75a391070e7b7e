// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/scan/range_limits.h"

namespace raymoval {

/// An amount of memory in MiB: "500" (MiB), or with a unit: "500MiB", "2GiB", "2G" and "2g" (powers
/// of 1024), "500MB", "2GB" (powers of 1000).
/// @param option for the message, such as "--memory-limit"
/// @throws UsageError saying what can be written
double parse_memory_mib(const std::string& option, const std::string& text);

/// A time in seconds: "90" (seconds), or with a unit: "90s", "5min", "5m", "2h", "1d".
/// @throws UsageError saying what can be written
double parse_seconds(const std::string& option, const std::string& text);

/// A range "MIN:MAX" in metres; either may be left out. @throws UsageError saying what was meant
RangeLimits parse_range(const std::string& option, const std::string& text);

}  // namespace raymoval
