// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "eval/comparison/compare.h"

namespace raymoval {

/// What was compared with what, for the head of a file.
struct ComparisonSubject {
  std::string run, reference;  ///< As the user named them.
  ComparisonOptions options;
};

/// The ways to write a comparison: "text", "md", "junit", "json".
const std::vector<std::string>& comparison_formats();

/// The comparison in one of these formats:
/// - "text": as `comparison_text`;
/// - "md": a table in Markdown of what is not the same, with a verdict;
/// - "junit": XML with a test suite for each sequence and a test case for each method and protocol.
///   What is worse has failed, what is not comparable is an error, and what is not compared because
///   only the run has it is skipped. Problems of the whole run stand in the suite "run", times that
///   are judged in test cases of their own;
/// - "json": see results/schema/comparison.schema.json.
/// @throws UsageError suggesting the nearest format
std::string comparison_in(const std::string& format, const Comparison& comparison,
                          const ComparisonSubject& subject);

}  // namespace raymoval
