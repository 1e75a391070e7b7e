// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

enum class Severity {
  kNote,     ///< True of the data and worth knowing, but nothing has to be done.
  kFinding,  ///< Results would be wrong or misleading.
};

/// What `raymoval clean` does about a finding (never about a note).
enum class Consequence {
  kRefused,  ///< The map would be wrong: refused, unless the user insists.
  kWarned,   ///< The map may be worse than it could be: said.
  kUnused,   ///< About labels, which cleaning does not use.
};

/// Something that an inspection found.
struct Finding {
  std::string check = {};  ///< Name in the table of checks, such as "poses-inverted".
  Severity severity = Severity::kFinding;
  std::string where = {};                          ///< File and frames.
  std::string what = {};                           ///< What was found, with numbers.
  std::string expected = {};                       ///< What good data has there.
  std::string remedy = {};                         ///< What to do.
  Consequence consequence = Consequence::kWarned;  ///< That of its check.

  /// "poses-inverted: poses.txt, ...: the scans agree to ...; expected .... Invert each pose."
  [[nodiscard]] std::string sentence() const {
    return check + ": " + where + ": " + what + "; expected " + expected + ". " + remedy;
  }
};

/// All that an inspection says.
struct InspectionReport {
  std::string sequence;
  std::string layout;
  std::size_t scans = 0;
  std::size_t scans_read = 0;
  std::string sensor;    ///< What it is called, and what the scans show of it; empty if unknown.
  std::string pose_fit;  ///< "poses fit to 0.02 m (...)"; empty if it was not measured.
  std::vector<Finding> findings;
  /// How it was opened, and the topics of a recording, in whole sentences.
  std::vector<std::string> notes = {};
  /// Numbers behind the findings, in a fixed order.
  std::vector<std::pair<std::string, double>> measures;

  /// Whether there is a finding that is no note.
  [[nodiscard]] bool has_findings() const {
    return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
      return finding.severity == Severity::kFinding;
    });
  }
};

}  // namespace raymoval
