// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// A line of a published table: texts that name the method and the data (empty if not given), and
/// the numbers by name. A number that is printed as missing has no value.
struct PublishedRow {
  std::string method, sequence, stage, poses, reported_by;
  std::map<std::string, std::optional<double>> values;

  /// No value if the row does not have it.
  [[nodiscard]] std::optional<double> value(const std::string& name) const;
};

/// A printed number that its own table contradicts.
struct Misprint {
  std::string method, metric;
  double printed = 0.0;
  double recomputed = 0.0;
};

/// A table of a paper as data; see results/published/.
struct PublishedTable {
  std::string table;     ///< "Raymoval paper, Table 2".
  std::string source;    ///< Where the numbers were read.
  std::string protocol;  ///< What was measured, on which frames.
  std::map<std::string, std::string> units;
  std::vector<PublishedRow> rows;
  std::vector<PublishedRow> averages_printed;   ///< As printed, misprints included.
  std::vector<PublishedRow> averages_computed;  ///< By a transcriber, where none is printed.
  std::vector<PublishedRow> totals_printed;     ///< Sums over stages, as printed.
  std::vector<Misprint> misprints;
  std::vector<std::string> notes;
};

/// @throws ConfigurationError naming the file, the place in it and what was expected
PublishedTable load_published_table(const std::filesystem::path& path);

}  // namespace raymoval
