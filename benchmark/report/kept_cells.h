// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// A cell whose removals are there.
struct KeptCell {
  std::string name;  ///< Of the method in the suite.
  bool control = false;
  std::filesystem::path removals;      ///< Folder of its label files.
  std::string digest;                  ///< Of its masks, as cell.json says.
  std::vector<std::string> sentences;  ///< Of its reasons; empty if it gave none.
};

/// The kept cells of a sequence, in the order of the suite.
/// @param results content of results.json
std::vector<KeptCell> kept_cells(const std::filesystem::path& run,
                                 const nlohmann::ordered_json& results,
                                 const std::string& sequence);

/// Paths that a user gave for sequences, by name.
using GivenPaths = std::map<std::string, std::string>;

/// Opens a sequence of a run again: where `given` says, else where the run read it. Its data has to
/// be what the cells were made of.
/// @throws DataError or UsageError naming the remedy
Sequence open_again(const std::filesystem::path& run, const nlohmann::ordered_json& results,
                    const std::string& sequence, const GivenPaths& given, int threads);

}  // namespace raymoval
