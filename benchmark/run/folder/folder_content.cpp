// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/folder_content.h"

#include <fmt/format.h>

#include <algorithm>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/checks/differences.h"
#include "benchmark/result/run_record_json.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

using std::filesystem::path;

/// "suite 'simulated' (6 sequences, 14 methods)".
std::string suite_words(const RunRecord& run) {
  return fmt::format("suite '{}' ({}, {})", run.suite,
                     counted_text(run.sequences.size(), "sequence"),
                     counted_text(run.methods.size(), "method"));
}

std::string why_other_sequences(const RunRecord& present, const RunRecord& asked) {
  for (const SequenceRecord& sequence : asked.sequences) {
    const SequenceRecord* known = find_named(present.sequences, name_of(sequence));
    if (known == nullptr) continue;
    DataRecord before = known->data;
    before.fingerprint.clear();  // That of `asked` is not known yet.
    const std::string difference = data_difference(before, sequence.data);
    if (difference.empty()) continue;
    return fmt::format("the folder holds results on other data called '{}': {}.", name_of(sequence),
                       difference);
  }
  return "";
}

/// A new version of a protocol does not make another suite: cells of the old version are run again
/// or left out.
std::vector<ProtocolRecord> without_versions(std::vector<ProtocolRecord> protocols) {
  for (ProtocolRecord& protocol : protocols) protocol.version.clear();
  return protocols;
}

std::string why_other_protocols(const RunRecord& present, const RunRecord& asked) {
  const std::vector<std::string> before = names_of(present.protocols);
  const std::vector<std::string> now = names_of(asked.protocols);
  if (before != now) {
    return fmt::format("the folder's results are scored by {}, and this run by {}.", join(before),
                       join(now));
  }
  const std::string difference =
      protocol_difference(without_versions(present.protocols), without_versions(asked.protocols));
  return difference.empty()
             ? ""
             : "the folder's results are scored with other options: " + difference + ".";
}

/// Two different names with the same folder, such as "a:b" and "a-b".
std::string why_shared_folder(const std::vector<std::string>& present,
                              const std::vector<std::string>& asked) {
  for (const std::string& name : asked) {
    for (const std::string& known : present) {
      if (name == known || folder_name(name) != folder_name(known)) continue;
      return fmt::format("the folder holds results of '{}', whose files '{}' would replace.", known,
                         name);
    }
  }
  return "";
}

/// Items of both lists, by name; an item of `asked` replaces one of the same name. The order is
/// that of `asked` if it has all items, else new items come last.
template <class Item>
std::vector<Item> merged_list(const std::vector<Item>& present, const std::vector<Item>& asked) {
  const bool has_all = std::all_of(present.begin(), present.end(), [&](const Item& item) {
    return find_named(asked, name_of(item)) != nullptr;
  });
  if (has_all) return asked;
  std::vector<Item> merged;
  for (const Item& item : present) {
    const Item* newer = find_named(asked, name_of(item));
    merged.push_back(newer == nullptr ? item : *newer);
  }
  for (const Item& item : asked) {
    if (find_named(present, name_of(item)) == nullptr) merged.push_back(item);
  }
  return merged;
}

/// The cells of both runs, sequence after sequence in the merged order.
std::vector<CellName> merged_cells(const RunRecord& merged, const RunRecord& present,
                                   const RunRecord& asked) {
  std::vector<CellName> known = present.cells;
  known.insert(known.end(), asked.cells.begin(), asked.cells.end());
  std::sort(known.begin(), known.end());
  std::vector<CellName> cells = merged.all_cells();
  std::erase_if(cells, [&](const CellName& cell) {
    return !std::binary_search(known.begin(), known.end(), cell);
  });
  return cells;
}

/// Why a stored cell no longer fits the other cells of the folder; empty if it does.
std::string why_left_out(const Cell& cell, const RunRecord& record,
                         const std::vector<ProtocolRecord>& protocols) {
  const SuiteMethodRecord* method = find_named(record.methods, cell.name);
  if (method == nullptr) return "its file is damaged";
  const std::string why = method_difference(cell.method, *method);
  if (!why.empty() || !cell.data) return why;
  const std::string known = known_fingerprint(record, cell.sequence);
  if (!known.empty() && cell.data->fingerprint != known) return "it was made on other data";
  return cell.ok() ? protocol_difference(protocols_of(cell), protocols) : "";
}

}  // namespace

std::optional<RunRecord> present_record(const path& out) {
  const path file = out / "run.json";
  if (!is_there(file)) return std::nullopt;
  std::string problem;
  try {
    return read_run_record(file);
  } catch (const UnreadableError&) {
    throw;
  } catch (const FieldError&) {
    problem = "it is not the record of a run";
  } catch (const SchemaVersionError&) {
    problem = "it is of another version of raymoval";
  } catch (const DataError&) {
    problem = "it is damaged, or was changed by hand";
  }
  throw DataError(
      fmt::format("{}: {}, so the content of the folder is unknown. Name another folder, or "
                  "replace its results with --overwrite.",
                  file.string(), problem));
}

std::string why_not_together(const RunRecord& present, const RunRecord& asked) {
  if (present.suite != asked.suite && present.suite != kUnnamedSuite &&
      asked.suite != kUnnamedSuite) {
    return fmt::format("the folder holds the results of {}, and this is {}.", suite_words(present),
                       suite_words(asked));
  }
  std::string why = why_other_sequences(present, asked);
  if (why.empty()) why = why_other_protocols(present, asked);
  if (why.empty()) why = why_shared_folder(names_of(present.sequences), names_of(asked.sequences));
  return why.empty() ? why_shared_folder(names_of(present.methods), names_of(asked.methods)) : why;
}

std::string why_other_data(const RunRecord& present, const std::string& sequence,
                           const std::string& fingerprint) {
  const std::string known = known_fingerprint(present, sequence);
  if (known.empty() || known == fingerprint) return "";
  return fmt::format(
      "the folder holds results on other data called '{}': its scans, poses or labels differ "
      "(fingerprint {}, now {}).",
      sequence, known, fingerprint);
}

void refuse_other_results(const path& out, const std::string& why) {
  if (why.empty()) return;
  throw UsageError("--out " + out.string() + ": " + why +
                   " Name another folder, or replace the results in this one with --overwrite.");
}

std::string known_fingerprint(const RunRecord& record, const std::string& sequence) {
  const SequenceRecord* known = find_named(record.sequences, sequence);
  return known == nullptr ? "" : known->data.fingerprint;
}

bool set_reading(RunRecord& record, const std::string& sequence, const std::string& fingerprint,
                 const std::optional<PoseFitRecord>& fit) {
  for (SequenceRecord& item : record.sequences) {
    if (name_of(item) != sequence) continue;
    if (item.data.fingerprint == fingerprint && item.pose_fit.has_value() == fit.has_value()) {
      return false;
    }
    item.data.fingerprint = fingerprint;
    item.pose_fit = fit;
    return true;
  }
  return false;
}

RunRecord merged_run_record(const RunRecord& present, const RunRecord& asked) {
  RunRecord merged = asked;
  if (asked.suite == kUnnamedSuite) merged.suite = present.suite;
  merged.sequences = merged_list(present.sequences, asked.sequences);
  merged.methods = merged_list(present.methods, asked.methods);
  merged.controls = asked.controls || present.controls;
  for (const SequenceRecord& sequence : present.sequences) {
    const std::string& known = sequence.data.fingerprint;
    if (!known.empty()) set_reading(merged, name_of(sequence), known, sequence.pose_fit);
  }
  merged.cells = merged_cells(merged, present, asked);
  return merged;
}

const Cell* EarlierCells::find(const CellName& cell) const {
  for (const Cell& one : kept) {
    if (one.sequence == cell.sequence && one.name == cell.name) return &one;
  }
  return nullptr;
}

std::vector<std::string> EarlierCells::lines() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < kept.size();) {
    const std::string& sequence = kept[i].sequence;
    std::vector<std::string> names;
    for (; i < kept.size() && kept[i].sequence == sequence; ++i) names.push_back(kept[i].name);
    lines.push_back("kept of earlier runs on " + sequence + ": " + join(names));
  }
  for (const std::string& cell : left_out) {
    lines.push_back("left out of the tables: " + cell + ". Run it again to have it.");
  }
  return lines;
}

EarlierCells read_earlier_cells(const CellStore& store, const RunRecord& record,
                                const RunRecord& asked) {
  std::vector<CellName> wanted = asked.cells;
  std::sort(wanted.begin(), wanted.end());
  EarlierCells earlier;
  for (const CellName& name : record.cells) {
    if (std::binary_search(wanted.begin(), wanted.end(), name)) continue;
    const path file = store.folder(name) / "cell.json";
    if (!is_there(file)) continue;
    std::string why = "its file is damaged";
    try {
      Cell cell = read_cell(file);
      why = why_left_out(cell, record, asked.protocols);
      if (why.empty()) earlier.kept.push_back(std::move(cell));
    } catch (const UnreadableError&) {
      throw;
    } catch (const DataError&) {
    }
    if (!why.empty()) earlier.left_out.push_back(name.title() + ": " + why);
  }
  return earlier;
}

}  // namespace raymoval
