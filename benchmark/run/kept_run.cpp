// SPDX-License-Identifier: MIT
#include "benchmark/run/kept_run.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/removal_files.h"
#include "benchmark/result/result_sets.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/suite/sequence_place.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/loaded_data.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
using std::filesystem::path;

std::string text_at(const ordered_json& json, const char* key) {
  return json.is_object() && json.contains(key) && json.at(key).is_string()
             ? json.at(key).get<std::string>()
             : "";
}

KeptCell kept_cell(const ordered_json& cell, const path& folder) {
  KeptCell kept;
  kept.sequence = cell.at("sequence").get<std::string>();
  kept.name = cell.at("name").get<std::string>();
  kept.control = cell.at("method").at("control").get<bool>();
  kept.status = cell.at("status").get<std::string>();
  kept.reason = cell.at("reason").get<std::string>();
  kept.fingerprint = text_at(cell.at("data"), "fingerprint");
  kept.digest = text_at(cell.at("masks"), "digest");
  kept.removals =
      folder / "cells" / folder_name(kept.sequence) / folder_name(kept.name) / "removals";
  return kept;
}

/// Every sequence x method of the suite; what is not among `cells` was not run.
std::vector<KeptCell> all_cells(const RunResults& results, const ordered_json& json,
                                const path& folder) {
  std::vector<KeptCell> there;
  for (const ordered_json& cell : json.at("cells")) there.push_back(kept_cell(cell, folder));
  std::vector<KeptCell> all;
  for (const std::string& sequence : results.sequences) {
    for (const std::string& name : results.cells) {
      const auto found = std::find_if(there.begin(), there.end(), [&](const KeptCell& cell) {
        return cell.sequence == sequence && cell.name == name;
      });
      if (found != there.end()) {
        all.push_back(*found);
        continue;
      }
      KeptCell missing;
      missing.sequence = sequence;
      missing.name = name;
      missing.status = "not run";
      all.push_back(missing);
    }
  }
  return all;
}

/// Where a sequence that was opened at `given` may be below `data`, likeliest first.
std::vector<std::string> places_below(const path& data, const std::string& given,
                                      const std::string& name) {
  std::vector<std::string> places;
  const std::size_t colon = given.rfind(':');
  if (colon != std::string::npos && is_folder(data / "sequences")) {
    places.push_back(data.string() + given.substr(colon));
  }
  for (const path& part : {path(name), path(given).filename()}) {
    if (!part.empty() && is_folder(data / part)) {
      places.push_back((data / part).string());
    }
  }
  places.push_back(data.string());
  return places;
}

/// `data` as a path that is never taken for a scene. @throws UsageError if it leads nowhere
std::string data_folder(const std::string& data) {
  const std::string root = data.substr(0, data.rfind(':'));  // ROOT:05
  if (!is_folder(data) && !is_folder(root)) {
    throw UsageError("--data " + data +
                     ": no such folder; expected a sequence's folder, or one that holds them by "
                     "name.");
  }
  const bool plain = data.find('/') == std::string::npos;
  return plain ? (path(".") / data).string() : data;
}

}  // namespace

bool KeptCell::has_removals() const {
  return has_result() && has_folder(removals);
}

std::string keep_removals_remedy(const KeptCell& cell) {
  return cell.sequence + " / " + cell.name +
         ": what it removed was not kept. Run the same command again with --keep-removals: only "
         "cells without it are run.";
}

KeptRun::KeptRun(const std::string& run, const std::string& data) {
  const path file = find_results(run);
  if (!data.empty()) data_ = data_folder(data);
  folder_ = file.parent_path();
  const ordered_json json = read_sealed(file);
  results_ = parse_results(json, file.string());
  try {
    cells_ = all_cells(results_, json, folder_);
    for (const ordered_json& sequence : json.at("run").at("suite").at("sequences")) {
      frames_[sequence.at("name").get<std::string>()] = text_at(sequence, "frames");
    }
    if (!has_file(folder_ / "run.json")) return;  // Only --data helps then.
    const ordered_json record = read_sealed(folder_ / "run.json");
    if (!record.contains("places")) return;  // Of an earlier version.
    for (std::size_t i = 0; i < results_.sequences.size(); ++i) {
      const ordered_json& place = record.at("places").at(i);
      if (!place.is_null()) places_[results_.sequences[i]] = place.dump();
    }
  } catch (const ordered_json::exception& error) {
    throw DataError(file.string() + ": not the results of a run (" + error.what() +
                    "). Run `raymoval run` again with the same --out.");
  }
}

const KeptCell& KeptRun::cell(const std::string& sequence, const std::string& name) const {
  for (const KeptCell& cell : cells_) {
    if (cell.sequence == sequence && cell.name == name) return cell;
  }
  const auto& sequences = results_.sequences;
  if (std::find(sequences.begin(), sequences.end(), sequence) == sequences.end()) {
    throw UsageError("--sequence " + sequence + ": this run has no such sequence." +
                     suggestion(sequence, sequences));
  }
  throw UsageError("--method " + name + ": this run has no such method." +
                   suggestion(name, results_.cells));
}

std::vector<const KeptCell*> KeptRun::cells_of(const std::string& sequence) const {
  std::vector<const KeptCell*> found;
  for (const KeptCell& cell : cells_) {
    if (cell.sequence == sequence) found.push_back(&cell);
  }
  return found;
}

SequenceRequest KeptRun::place_of(const std::string& sequence) const {
  const auto known = places_.find(sequence);
  if (known != places_.end()) return place_from(ordered_json::parse(known->second));
  if (data_.empty()) {
    throw DataError(folder_.string() + ": run.json does not say where sequence '" + sequence +
                    "' is (it is missing, or of an earlier version). Say it with --data.");
  }
  SequenceRequest place;
  const std::string& frames = frames_.at(sequence);
  if (!frames.empty()) place.options.frames = parse_frame_range(frames);
  place.options.name = sequence;
  return place;
}

Sequence KeptRun::open(const std::string& sequence, const OpenContext& context) const {
  const SequenceRequest place = place_of(sequence);
  std::string wanted;
  for (const KeptCell* cell : cells_of(sequence)) {
    if (wanted.empty()) wanted = cell->fingerprint;
  }
  std::vector<std::string> tried = {place.path};
  if (!data_.empty()) tried = places_below(data_, place.path, sequence);
  std::string problem;
  for (const std::string& at : tried) {
    try {
      Sequence opened = open_sequence(at, place.options, context);
      if (wanted.empty() || fingerprint(opened, context.threads) == wanted) return opened;
      problem = at +
                ": is not the data that the run was made on: its fingerprint is another. It was "
                "changed, or it is another sequence; say where the right one is with --data, or "
                "run again.";
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      if (problem.empty()) problem = error.what();
    }
  }
  throw DataError("sequence '" + sequence + "' cannot be opened again: " + problem +
                  (data_.empty() ? " If it was moved, say where it is with --data." : ""));
}

MaskStore KeptRun::masks(const KeptCell& cell, const Sequence& sequence) const {
  if (!cell.has_result()) {
    throw DataError(cell.sequence + " / " + cell.name + ": " + cell.status +
                    (cell.reason.empty() ? "" : ", " + cell.reason) + ".");
  }
  if (!cell.has_removals()) throw DataError(keep_removals_remedy(cell));
  MaskStore masks = read_removals(cell.removals, *sequence.scans, [] {});
  if (mask_digest(masks) != cell.digest) {
    throw DataError(cell.removals.string() +
                    ": does not hold what the method was scored by; it was changed. Remove the "
                    "folder and run the same command again with --keep-removals.");
  }
  return masks;
}

}  // namespace raymoval
