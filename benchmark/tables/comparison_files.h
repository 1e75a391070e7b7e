// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/comparison/compare.h"

namespace raymoval {

/// The two compared runs, for the head of a file.
struct ComparisonSubject {
  std::string run, reference;  ///< As the user named them.
};

/// The ways to write a comparison: "text", "md", "junit".
const std::vector<std::string>& comparison_formats();

/// The comparison in one of these formats:
/// - "text": as `comparison_text`;
/// - "md": a table in Markdown of the differences, with a verdict;
/// - "junit": XML with a test suite for each sequence and a test case for each method and protocol.
///   A worse score is a failure, an incomparable one an error, and one that only the run has is
///   skipped. Problems of the whole run are in the suite "run", judged times in separate test
///   cases.
/// @throws UsageError suggesting the nearest format
std::string comparison_in(const std::string& format, const Comparison& comparison,
                          const ComparisonSubject& subject);

}  // namespace raymoval
