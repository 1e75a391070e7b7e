// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/result/cell.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// A sequence of a run.
struct SequenceRecord {
  DataRecord data;  ///< Its fingerprint is empty until the data has been read.
  /// Where it was found, with absolute paths. Only run.json has it; no value in files of earlier
  /// versions.
  std::optional<SequenceRequest> place = std::nullopt;
  std::optional<PoseFitRecord> pose_fit = std::nullopt;  ///< No value until it was measured.
};

/// The point of a sweep that a method of a run is.
struct SweepRecord {
  std::string of;        ///< Name without the swept values, "raymoval:offline".
  Configuration values;  ///< The swept values of this point.
};

/// A method of a run.
struct SuiteMethodRecord {
  std::string name;    ///< Unique in the suite.
  std::string method;  ///< With its variant, "raymoval:online".
  std::string version;
  Configuration parameters = {};
  std::optional<SweepRecord> sweep = std::nullopt;  ///< No value if it is no point of a sweep.
  /// The variant's values of the parameters that differ from it, without swept ones.
  std::optional<Configuration> changed_from = std::nullopt;
};

/// Identifies a cell of a run.
struct CellName {
  std::string sequence;
  std::string name;  ///< Name of the method in the suite.

  friend auto operator<=>(const CellName&, const CellName&) = default;
  /// "town / raymoval:online", for messages.
  [[nodiscard]] std::string title() const { return sequence + " / " + name; }
};

/// The version and the compiler of the program.
struct BuildRecord {
  std::string version;
  std::string commit, source_tree;  ///< Empty in files of earlier versions.
  std::string compiler, build_type;
};

/// The machine of a run.
struct MachineRecord {
  std::string processor;
  int cores = 0;
  std::optional<std::int64_t> memory_gib = std::nullopt;
  int threads = 0;  ///< Threads of the run.
  /// Cells that ran at once, each with these threads. No value: one cell at a time.
  std::optional<int> jobs = std::nullopt;
};

/// The content of run.json: the resolved suite, its cells, build and machine.
struct RunRecord {
  std::string suite = {};  ///< Its name.
  std::vector<SequenceRecord> sequences = {};
  std::vector<SuiteMethodRecord> methods = {};
  std::vector<ProtocolRecord> protocols = {};
  bool controls = true;              ///< Whether the controls are checked.
  std::vector<CellName> cells = {};  ///< Empty in results.json, which has the cells themselves.
  std::optional<BuildRecord> build = std::nullopt;      ///< No value in a reference.
  std::optional<MachineRecord> machine = std::nullopt;  ///< No value in a reference without times.

  /// Every sequence with every method, sequence after sequence.
  [[nodiscard]] std::vector<CellName> all_cells() const;
};

/// The content of results.json.
struct ResultsRecord {
  RunRecord run;
  bool controls_checked = true;
  std::vector<std::string> control_problems = {};
  std::vector<std::string> missing = {};  ///< Cells that were not run, "town / raymoval:online".
  std::vector<Cell> cells = {};  ///< By sequence, then by method, in the order of the suite.

  /// The cell of a sequence and method; null if there is none.
  [[nodiscard]] const Cell* find(const CellName& name) const;
};

/// The name of a sequence, method or protocol of a run.
inline const std::string& name_of(const SequenceRecord& sequence) {
  return sequence.data.name;
}
inline const std::string& name_of(const SuiteMethodRecord& method) {
  return method.name;
}
inline const std::string& name_of(const ProtocolRecord& protocol) {
  return protocol.name;
}

template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& list) {
  std::vector<std::string> names;
  for (const Item& item : list) names.push_back(name_of(item));
  return names;
}

/// The item of a list of sequences, methods or protocols with this name; null if there is none.
template <class Item>
const Item* find_named(const std::vector<Item>& list, const std::string& name) {
  for (const Item& item : list) {
    if (name_of(item) == name) return &item;
  }
  return nullptr;
}

}  // namespace raymoval
