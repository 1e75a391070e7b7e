// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

enum class Severity {
  kNote,     ///< A fact worth knowing that needs no action.
  kFinding,  ///< Results would be wrong or misleading.
};

/// The reaction of `raymoval clean` to a finding (not to a note).
enum class Consequence {
  kRefused,  ///< The map would be wrong: refused unless forced.
  kWarned,   ///< The map may be worse: warned.
  kUnused,   ///< About labels, which cleaning does not use.
};

/// A result of an inspection.
struct Finding {
  std::string check = {};  ///< Name in the table of checks, such as "poses-inverted".
  Severity severity = Severity::kFinding;
  std::string where = {};                          ///< File and frames.
  std::string what = {};                           ///< The defect or fact, with numbers.
  std::string expected = {};                       ///< The property of good data.
  std::string remedy = {};                         ///< The recommended action.
  Consequence consequence = Consequence::kWarned;  ///< From its check.

  /// "poses-inverted: poses.txt, ...: the scans agree to ...; expected .... Invert each pose."
  [[nodiscard]] std::string sentence() const {
    return check + ": " + where + ": " + what + "; expected " + expected + ". " + remedy;
  }
};

/// The result of an inspection.
struct InspectionReport {
  std::string sequence;
  std::string layout;
  std::size_t scans = 0;
  std::size_t scans_read = 0;
  std::string sensor;    ///< Its name and its estimated properties; empty if unknown.
  std::string pose_fit;  ///< "poses fit to 0.02 m (...)"; empty if it was not measured.
  std::vector<Finding> findings;
  /// How it was opened, and the topics of a recording, in whole sentences.
  std::vector<std::string> notes = {};
  /// Numbers behind the findings, in a fixed order.
  std::vector<std::pair<std::string, double>> measures;

  /// Whether any finding is not a note.
  [[nodiscard]] bool has_findings() const {
    return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
      return finding.severity == Severity::kFinding;
    });
  }
};

}  // namespace raymoval
