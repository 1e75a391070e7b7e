// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "core/scan/range_limits.h"

namespace raymoval {

/// Reads an amount of memory in MiB, or in its unit: "500MiB", "2GiB", "2G" and "2g" count in
/// powers of 1024, "500MB" and "2GB" in powers of 1000.
/// @param option for the message, such as "--memory-limit"
/// @throws UsageError that says what can be written
double parse_memory_mib(const std::string& option, const std::string& text);

/// Reads a time in seconds, or in its unit: "90s", "5min", "5m", "2h", "1d".
/// @throws UsageError that says what can be written
double parse_seconds(const std::string& option, const std::string& text);

/// Reads a decimal number greater than 0. @param option for the message. @throws UsageError
double parse_positive(const std::string& option, const std::string& text);

/// Reads a whole number. @param what such as "a whole number of pixels" @throws UsageError
int parse_whole(const std::string& option, const std::string& text, int low, int high,
                const std::string& what = "a whole number", const std::string& example = "");

/// Reads a range "MIN:MAX" in metres; either number may be left out.
/// @throws UsageError that says what can be written
RangeLimits parse_range(const std::string& option, const std::string& text);

}  // namespace raymoval
