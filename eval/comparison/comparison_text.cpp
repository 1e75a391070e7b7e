// SPDX-License-Identifier: MIT
#include <array>
#include <string_view>

#include "core/text.h"
#include "eval/comparison/compare.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

std::string value_words(const std::optional<double>& value) {
  return value ? fixed_text(*value, 4) : "undefined";
}

/// The names, or the first few and the number of the others.
std::string few_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 5;
  if (names.size() <= kMost + 1) return join(names);
  return join({names.begin(), names.begin() + kMost}) + " and " +
         std::to_string(names.size() - kMost) + " more";
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  for (const std::string& known : names) {
    if (known == name) return;
  }
  names.push_back(name);
}

/// A sentence that holds for each of `sequences` with each of `names`.
struct CommonLine {
  std::vector<std::string> sequences, names;
  std::string protocol, text;

  [[nodiscard]] std::string line() const {
    std::string where;
    if (!sequences.empty()) where = few_names(sequences) + " / " + few_names(names);
    if (!protocol.empty()) where += ", " + protocol;
    return where.empty() ? text : where + ": " + text;
  }
};

/// Combines first the methods of each sequence, then sequences with the same methods.
std::vector<CommonLine> lines_in_common(const std::vector<ComparisonLine>& lines, Change change) {
  std::vector<CommonLine> by_sequence;
  for (const ComparisonLine& line : lines) {
    if (line.change != change) continue;
    CommonLine* found = nullptr;
    for (CommonLine& known : by_sequence) {
      const bool here = line.sequence.empty() ? known.sequences.empty()
                                              : known.sequences == std::vector{line.sequence};
      if (here && known.protocol == line.protocol && known.text == line.text) found = &known;
    }
    if (found == nullptr) {
      by_sequence.push_back({{}, {}, line.protocol, line.text});
      found = &by_sequence.back();
      if (!line.sequence.empty()) found->sequences.push_back(line.sequence);
    }
    if (!line.name.empty()) add_once(found->names, line.name);
  }
  std::vector<CommonLine> groups;
  for (const CommonLine& one : by_sequence) {
    CommonLine* found = nullptr;
    for (CommonLine& known : groups) {
      if (known.names == one.names && known.protocol == one.protocol && known.text == one.text) {
        found = &known;
      }
    }
    if (found == nullptr) {
      groups.push_back(one);
    } else {
      for (const std::string& sequence : one.sequences) add_once(found->sequences, sequence);
    }
  }
  return groups;
}

}  // namespace

std::string side_by_side_text(const TimeChange& time) {
  return "times were not taken alike: with " + std::to_string(time.after_side_by_side) +
         " cells at once (run --jobs), the reference with " +
         std::to_string(time.before_side_by_side);
}

std::string change_text(const RateChange& rate) {
  std::string text = rate.name + " " + value_words(rate.before) + " -> " + value_words(rate.after);
  if (!rate.before || !rate.after) return text;
  const double change = *rate.after - *rate.before;
  text += std::string(" (") + (change > 0 ? "+" : "") + fixed_text(change, 4);
  if (rate.tolerance && rate.change == Change::kWorse && *rate.tolerance > 0.0) {
    const char* worse = rate_spec(rate.name).higher_is_better ? "-" : "+";
    text += std::string(", at most ") + worse + number_text(*rate.tolerance) + " is allowed";
  }
  return text + ")";
}

std::string change_text(const CountChange& count) {
  if (!count.after) return "count " + count.name + " is missing";
  if (!count.before) return "count " + count.name + " is new";
  const std::int64_t change = *count.after - *count.before;
  return count.name + " " + std::to_string(*count.before) + " -> " + std::to_string(*count.after) +
         " (" + (change > 0 ? "+" : "") + std::to_string(change) + ")";
}

std::string change_text(const TimeChange& time) {
  if (time.before && time.after && !time.has_equal_load()) {
    return side_by_side_text(time) + "; leave --time-band out";
  }
  if (time.change == Change::kIncomparable) return "no time on both sides; leave --time-band out";
  return fixed_text(time.ratio(), 2) + " times the reference (" + fixed_text(*time.after * 1e3, 1) +
         " ms per scan, was " + fixed_text(*time.before * 1e3, 1) + ")";
}

std::string comparison_text(const Comparison& comparison) {
  constexpr std::array<std::pair<const char*, Change>, 4> kParts = {{
      {"Not comparable", Change::kIncomparable},
      {"Worse", Change::kWorse},
      {"Better", Change::kBetter},
      {"Moved or new", Change::kMoved},
  }};
  std::string text;
  for (const auto& [heading, change] : kParts) {
    const std::vector<CommonLine> groups = lines_in_common(comparison.lines, change);
    if (!groups.empty()) text += std::string(heading) + ":\n";
    for (const CommonLine& group : groups) text += "  " + group.line() + "\n";
  }
  if (!comparison.times.empty()) text += "Time:\n";
  for (const std::string& line : comparison.times) text += "  " + line + "\n";
  return text + std::to_string(comparison.same_cells) + " of " + std::to_string(comparison.cells) +
         " cells are the same as in the reference: " + comparison.verdict_words() + ".\n";
}

}  // namespace raymoval
