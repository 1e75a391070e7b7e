// SPDX-License-Identifier: MIT
#include "benchmark/report/kept_cells.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmark/reasons.h"
#include "benchmark/sequence_places.h"
#include "benchmark/suite.h"
#include "core/error.h"
#include "core/sensor_model.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

fs::path removals_folder(const fs::path& run, const ordered_json& cell) {
  return run / "cells" / folder_name(cell.at("sequence").get<std::string>()) /
         folder_name(cell.at("name").get<std::string>()) / "removals";
}

const ordered_json& sequence_record(const ordered_json& results, const std::string& sequence) {
  for (const ordered_json& record : results.at("run").at("suite").at("sequences")) {
    if (record.at("name") == sequence) return record;
  }
  throw UsageError("sequence '" + sequence + "' is not in this run.");
}

/// Options under which a folder reads as it did in the run.
SequenceOptions recorded_options(const ordered_json& record) {
  SequenceOptions options;
  options.name = record.at("name").get<std::string>();
  options.frames = parse_frame_range(record.at("frames").get<std::string>());
  options.range_m.emplace();
  options.range_m->min = record.at("range_m").at("min").get<double>();
  if (const ordered_json& max = record.at("range_m").at("max"); !max.is_null()) {
    options.range_m->max = max.get<double>();
  }
  const auto sensor = record.at("sensor").get<std::string>();
  const std::vector<std::string> known = sensor_model_names();
  if (std::find(known.begin(), known.end(), sensor) != known.end()) options.sensor = sensor;
  return options;
}

SequenceRequest place_of(const fs::path& run, const ordered_json& results,
                         const std::string& sequence, const GivenPaths& given) {
  const ordered_json& record = sequence_record(results, sequence);
  if (const auto path = given.find(sequence); path != given.end()) {
    return {path->second, recorded_options(record)};
  }
  const auto sources = read_sources(run);
  if (const auto source = sources.find(sequence); source != sources.end()) return source->second;
  if (sequence == "street" && record.at("layout") == "simulated") {
    return {"street", recorded_options(record)};
  }
  throw DataError("the run does not say where sequence '" + sequence +
                  "' lies. Name it: --sequence '" + sequence + "=PATH'.");
}

/// Of the cells of a sequence; empty if all of them failed.
std::string recorded_fingerprint(const ordered_json& results, const std::string& sequence) {
  for (const ordered_json& cell : results.at("cells")) {
    if (cell.at("sequence") != sequence || cell.at("data").is_null()) continue;
    return cell.at("data").at("fingerprint").get<std::string>();
  }
  return "";
}

}  // namespace

std::vector<KeptCell> kept_cells(const fs::path& run, const ordered_json& results,
                                 const std::string& sequence) {
  std::vector<KeptCell> kept;
  std::error_code ignored;
  for (const ordered_json& cell : results.at("cells")) {
    if (cell.at("sequence") != sequence || cell.at("status") != "ok") continue;
    const fs::path removals = removals_folder(run, cell);
    if (!fs::is_directory(removals, ignored)) continue;
    kept.push_back({cell.at("name").get<std::string>(), cell.at("method").at("control").get<bool>(),
                    removals, cell.at("masks").at("digest").get<std::string>(),
                    read_reason_sentences(removals)});
  }
  return kept;
}

Sequence open_again(const fs::path& run, const ordered_json& results, const std::string& sequence,
                    const GivenPaths& given, int threads) {
  const SequenceRequest place = place_of(run, results, sequence, given);
  const std::string remedy =
      " Name the folder that the run read: --sequence '" + sequence + "=PATH'.";
  Sequence opened;
  try {
    opened = open_sequence(place.path, place.options, {threads, nullptr, nullptr});
  } catch (const DataError& error) {
    throw DataError(error.what() + remedy);
  }
  const ordered_json& record = sequence_record(results, sequence);
  if (const ordered_json& rule = record.at("label_rule"); !rule.is_null()) {
    opened.label_rule = label_rule_from_json(rule, opened.label_rule, "label rule of the run");
  }
  if (!opened.labels || opened.scans->size() == 0) {
    throw DataError(place.path + ": has no labels or no scan, unlike what the run read." + remedy);
  }
  if (fingerprint(opened, threads) != recorded_fingerprint(results, sequence)) {
    throw DataError(place.path + ": other points, poses, labels or sensor than the run read." +
                    remedy);
  }
  return opened;
}

}  // namespace raymoval
