// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/kept_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/removals/removal_files.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/folder/cell_store.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/fingerprint.h"

namespace raymoval {
namespace {

using std::filesystem::path;

/// The opened sequence is not that of the run.
class OtherData : public DataError {
 public:
  OtherData(const std::string& at, const std::string& difference)
      : DataError(at + ": is not the data that the run was made on: " + difference +
                  ". It was changed, or it is another sequence; name the right folder with --data, "
                  "or run again.") {}
};

/// Every sequence x method of the suite; some may not have been run.
std::vector<KeptCell> all_cells(const ResultsRecord& record, const path& folder) {
  std::vector<KeptCell> all;
  for (const CellName& name : record.run.all_cells()) {
    KeptCell kept{name.sequence,
                  name.name,
                  false,
                  "not run",
                  "",
                  record.find(name),
                  CellStore(folder).folder(name) / "removals"};
    if (kept.cell != nullptr) {
      kept.control = kept.cell->method.control;
      kept.status = status_name(kept.cell->status);
      kept.reason = kept.cell->reason;
    }
    all.push_back(std::move(kept));
  }
  return all;
}

/// Adds the places of the sequences, which only run.json has, to the record.
void add_places(const path& run_json, ResultsRecord& record) {
  if (!has_file(run_json)) return;  // Only --data helps then.
  const RunRecord run = read_run_record(run_json);
  for (SequenceRecord& sequence : record.run.sequences) {
    const SequenceRecord* known = find_named(run.sequences, name_of(sequence));
    if (known != nullptr) sequence.place = known->place;
  }
}

/// Possible places below `data` of a sequence that was opened at `given`, the likeliest first.
std::vector<std::string> places_below(const path& data, const std::string& given,
                                      const std::string& name) {
  std::vector<std::string> places;
  const std::size_t colon = given.rfind(':');
  if (colon != std::string::npos && is_folder(data / "sequences")) {
    places.push_back(data.string() + given.substr(colon));
  }
  for (const path& part : {path(name), path(given).filename()}) {
    if (!part.empty() && part != ".." && is_folder(data / part)) {
      places.push_back((data / part).string());
    }
  }
  places.push_back(data.string());
  return places;
}

/// `data` as a path that is never taken for a scene. @throws UsageError if it does not exist
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
         ": its removals were not stored. Run the same command again with --keep-removals: only "
         "cells without it are run.";
}

KeptRun::KeptRun(const std::string& run, const std::string& data, bool simulate)
    : simulate_(simulate) {
  const path file = find_results(run);
  if (!data.empty()) data_ = data_folder(data);
  folder_ = file.parent_path();
  record_ = read_results(file);
  add_places(folder_ / "run.json", record_);
  results_ = shown_results(record_);
  cells_ = all_cells(record_, folder_);
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
                   suggestion(name, results_.methods));
}

std::vector<const KeptCell*> KeptRun::cells_of(const std::string& sequence) const {
  std::vector<const KeptCell*> found;
  for (const KeptCell& cell : cells_) {
    if (cell.sequence == sequence) found.push_back(&cell);
  }
  return found;
}

SequenceRequest KeptRun::place_of(const std::string& sequence) const {
  const SequenceRecord* known = find_named(record_.run.sequences, sequence);
  if (known != nullptr && known->place) return *known->place;
  if (data_.empty()) {
    throw DataError(folder_.string() + ": run.json has no folder for sequence '" + sequence +
                    "' (it is missing). Name its folder with --data.");
  }
  SequenceRequest place;
  if (known != nullptr && !known->data.frames.empty()) {
    place.options.frames = parse_frame_range(known->data.frames);
  }
  place.options.name = sequence;
  return place;
}

/// Fingerprint of a sequence's data; empty if it could not be read.
std::string KeptRun::fingerprint_of(const std::string& sequence) const {
  for (const Cell& cell : record_.cells) {
    if (cell.sequence == sequence && cell.data) return cell.data->fingerprint;
  }
  return "";
}

std::size_t KeptRun::scans_of(const std::string& sequence) const {
  const SequenceRecord* known = find_named(record_.run.sequences, sequence);
  return known == nullptr ? 0 : known->data.scans;
}

Sequence KeptRun::open_at(const std::string& at, const std::string& sequence,
                          const SequenceRequest& place, const OpenContext& context) const {
  if (!simulate_ && !is_at_hand(at)) {
    throw DataError(at +
                    ": is a scene that is not in the cache. Add --simulate to simulate it, if you "
                    "have the time and disk space.");
  }
  Sequence opened = open_sequence(at, place.options, context);
  const std::size_t scans = scans_of(sequence), found = opened.scans->size();
  if (scans != 0 && found != scans) {
    throw OtherData(at, fmt::format("it holds {}, and the run had {}", counted_text(found, "scan"),
                                    grouped_text(scans)));
  }
  const std::string wanted = fingerprint_of(sequence);
  if (wanted.empty() || fingerprint(opened, context.threads) == wanted) return opened;
  throw OtherData(at, "its fingerprint is another");
}

Sequence KeptRun::open(const std::string& sequence, const OpenContext& context) const {
  const SequenceRequest place = place_of(sequence);
  std::vector<std::string> tried = {place.path};
  if (!data_.empty()) tried = places_below(data_, place.path, sequence);
  std::string problem;
  for (const std::string& at : tried) {
    try {
      return open_at(at, sequence, place, context);
    } catch (const Cancelled&) {
      throw;
    } catch (const UnreadableError&) {
      throw;
    } catch (const OtherData& error) {
      problem = error.what();
    } catch (const Error& error) {
      if (problem.empty()) problem = error.what();
    }
  }
  throw DataError("sequence '" + sequence + "' cannot be opened again: " + problem +
                  (data_.empty() ? " If it was moved, name its folder with --data." : ""));
}

MaskStore KeptRun::masks(const KeptCell& cell, const Sequence& sequence) const {
  if (!cell.has_result()) {
    throw DataError(cell.sequence + " / " + cell.name + ": " + cell.status +
                    (cell.reason.empty() ? "" : ", " + cell.reason) + ".");
  }
  if (!cell.has_removals()) throw DataError(keep_removals_remedy(cell));
  MaskStore masks = read_removals(cell.removals, *sequence.scans, [] {});
  if (!cell.cell->masks || mask_digest(masks) != cell.cell->masks->digest) {
    throw DataError(cell.removals.string() +
                    ": is not what was scored; it was changed. Remove the folder and run the same "
                    "command again with --keep-removals.");
  }
  return masks;
}

}  // namespace raymoval
