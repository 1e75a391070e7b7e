// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/scan/scan_source.h"

namespace raymoval {

/// Why a method removed or kept each point.
struct Reasons {
  std::vector<std::string> sentences;            ///< Of each code.
  std::vector<std::vector<std::uint8_t>> codes;  ///< By scan; empty for a scan without reasons.

  [[nodiscard]] bool empty() const { return sentences.empty(); }
};

/// Writes `reasons.json` (the sentences) and `<scan name>.reason` (a byte for each point of the
/// scan, in its order) beside the label files in `folder`. Without reasons it writes nothing.
void write_reasons(const std::filesystem::path& folder, const ScanSource& scans,
                   const Reasons& reasons);

/// Whether `write_reasons` writes a file of this name.
bool is_reason_file(const std::filesystem::path& name);

/// The sentences beside kept label files; none if the method gave none.
/// @throws DataError if they are damaged
std::vector<std::string> read_reason_sentences(const std::filesystem::path& folder);

/// The codes of a scan, each below `sentences`; empty if there are none.
/// @throws DataError if the file does not fit the scan
std::vector<std::uint8_t> read_reasons(const std::filesystem::path& folder, const Scan& scan,
                                       std::size_t sentences);

}  // namespace raymoval
