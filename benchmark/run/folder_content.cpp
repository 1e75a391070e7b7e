// SPDX-License-Identifier: MIT
#include "benchmark/run/folder_content.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmark/result/cell.h"
#include "benchmark/result/sealed_json.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
using std::filesystem::path;

std::string name_of(const ordered_json& item) {
  return item.at("name").get<std::string>();
}

/// The item of a list of the suite with this name; null if there is none.
const ordered_json* find_named(const ordered_json& list, const std::string& name) {
  for (const ordered_json& item : list) {
    if (name_of(item) == name) return &item;
  }
  return nullptr;
}

bool has_all_names_of(const ordered_json& list, const ordered_json& others) {
  return std::all_of(others.begin(), others.end(), [&](const ordered_json& item) {
    return find_named(list, name_of(item)) != nullptr;
  });
}

ordered_json without(ordered_json record, const char* key) {
  record.erase(key);
  return record;
}

std::string suite_name_of(const ordered_json& record) {
  return name_of(record.at("suite"));
}

/// "suite 'simulated' (6 sequences, 14 methods)".
std::string suite_words(const ordered_json& record) {
  const ordered_json& suite = record.at("suite");
  return "suite '" + name_of(suite) + "' (" +
         counted_text(suite.at("sequences").size(), "sequence") + ", " +
         counted_text(suite.at("methods").size(), "method") + ")";
}

std::string why_other_sequences(const ordered_json& present, const ordered_json& asked) {
  for (const ordered_json& sequence : asked.at("suite").at("sequences")) {
    const ordered_json* known = find_named(present.at("suite").at("sequences"), name_of(sequence));
    if (known == nullptr) continue;
    const std::string difference = record_difference("", without(*known, "fingerprint"), sequence);
    if (difference.empty()) continue;
    return "the folder holds results on other data called '" + name_of(sequence) +
           "': " + difference + ".";
  }
  return "";
}

std::string why_other_protocols(const ordered_json& present, const ordered_json& asked) {
  // A new version of a protocol is no other suite: what it does not fit is run again or left out.
  ordered_json lists[2];
  std::vector<std::string> names[2];
  for (const int i : {0, 1}) {
    const ordered_json& record = i == 0 ? present : asked;
    lists[i] = ordered_json::array();
    for (const ordered_json& protocol : record.at("suite").at("protocols")) {
      lists[i].push_back(without(protocol, "version"));
      names[i].push_back(name_of(protocol));
    }
  }
  if (names[0] != names[1]) {
    return "the folder's results are scored by " + join(names[0]) + ", and this run by " +
           join(names[1]) + ".";
  }
  const std::string difference = protocol_difference(lists[0], lists[1]);
  return difference.empty() ? "" : "the folder's results are scored otherwise: " + difference + ".";
}

/// Two names that differ and have one folder, as "a:b" and "a-b" do.
std::string why_shared_folder(const ordered_json& present, const ordered_json& asked) {
  for (const char* list : {"sequences", "methods"}) {
    for (const ordered_json& one : asked.at("suite").at(list)) {
      for (const ordered_json& other : present.at("suite").at(list)) {
        const std::string name = name_of(one), known = name_of(other);
        if (name == known || folder_name(name) != folder_name(known)) continue;
        return "the folder holds results of '" + known + "', whose files '" + name +
               "' would replace.";
      }
    }
  }
  return "";
}

/// Items of both lists, by name: those of `asked` stand for what both have. The order is that of
/// `asked` if it has all, else what is new comes last.
ordered_json merged_list(const ordered_json& present, const ordered_json& asked) {
  if (has_all_names_of(asked, present)) return asked;
  ordered_json merged = ordered_json::array();
  for (const ordered_json& item : present) {
    const ordered_json* newer = find_named(asked, name_of(item));
    merged.push_back(newer == nullptr ? item : *newer);
  }
  for (const ordered_json& item : asked) {
    if (find_named(present, name_of(item)) == nullptr) merged.push_back(item);
  }
  return merged;
}

/// One text for the pair, to look it up.
std::string cell_text(const std::string& sequence, const std::string& name) {
  return sequence + "/" + name;
}

/// The cells of both runs, sequence after sequence in the merged order.
ordered_json merged_cells(const ordered_json& suite, const ordered_json& present,
                          const ordered_json& asked) {
  std::vector<std::string> known;
  for (const ordered_json* record : {&present, &asked}) {
    for (const FolderCell& cell : folder_cells(*record)) {
      known.push_back(cell_text(cell.sequence, cell.name));
    }
  }
  std::sort(known.begin(), known.end());
  ordered_json cells = ordered_json::array();
  for (const ordered_json& sequence : suite.at("sequences")) {
    for (const ordered_json& method : suite.at("methods")) {
      const std::string text = cell_text(name_of(sequence), name_of(method));
      if (std::binary_search(known.begin(), known.end(), text)) {
        cells.push_back({{"sequence", name_of(sequence)}, {"name", name_of(method)}});
      }
    }
  }
  return cells;
}

/// Where each sequence of `suite` was found; null where an earlier version did not say it.
ordered_json merged_places(const ordered_json& suite, const ordered_json& present,
                           const ordered_json& asked) {
  ordered_json places = ordered_json::array();
  for (const ordered_json& sequence : suite.at("sequences")) {
    ordered_json place = nullptr;
    for (const ordered_json* record : {&present, &asked}) {
      const ordered_json& list = record->at("suite").at("sequences");
      for (std::size_t i = 0; record->contains("places") && i < list.size(); ++i) {
        if (name_of(list[i]) == name_of(sequence)) place = record->at("places").at(i);
      }
    }
    places.push_back(std::move(place));
  }
  return places;
}

/// Why a cell that is there does not fit the others of the folder any more; empty if it does.
std::string why_left_out(const ordered_json& cell, const ordered_json& record,
                         const ordered_json& protocols) {
  const ordered_json& suite = record.at("suite");
  const ordered_json* method = find_named(suite.at("methods"), name_of(cell));
  const ordered_json& made = cell.at("method");
  std::string why = record_difference("parameter", made.at("parameters"), method->at("parameters"));
  if (why.empty() && made.at("version") != method->at("version")) {
    why =
        "method version was " + made.at("version").dump() + ", is " + method->at("version").dump();
  }
  const ordered_json& data = cell.at("data");
  if (!why.empty() || data.is_null()) return why;
  const auto sequence = cell.at("sequence").get<std::string>();
  const std::string known = known_fingerprint(record, sequence);
  if (!known.empty() && data.at("fingerprint") != known) return "it was made on other data";
  return cell.at("status") == "ok" ? protocol_difference(cell.at("protocols"), protocols) : "";
}

std::vector<Measurement> further_runs(const CellStore& store, const FolderCell& cell,
                                      const ordered_json& json) {
  std::vector<Measurement> runs;
  if (json.at("status") != "ok") return runs;
  for (int round = 2;; ++round) {
    const auto repeat =
        store.find_repeat(cell.sequence, cell.name, round, json.at("key").get<std::string>());
    if (!repeat || repeat->digest != json.at("masks").at("digest")) return runs;
    runs.push_back(repeat->measured);
  }
}

}  // namespace

ordered_json read_run_record(const path& out) {
  const path file = out / "run.json";
  if (!is_there(file)) return nullptr;
  const auto unreadable = [&](const std::string& problem) {
    return DataError(file.string() + ": " + problem +
                     ", so what the folder holds cannot be told. Name another folder, or replace "
                     "its results with --overwrite.");
  };
  ordered_json record;
  try {
    record = read_sealed(file);
  } catch (const DataError&) {
    throw unreadable("it is damaged, or was changed by hand");
  }
  try {
    if (record.at("schema_version") == kSchemaVersion) {
      (void)folder_cells(record);
      for (const char* list : {"sequences", "methods", "protocols"}) {
        for (const ordered_json& item : record.at("suite").at(list)) (void)name_of(item);
      }
      return record;
    }
  } catch (const ordered_json::exception&) {
    throw unreadable("it is not the record of a run");
  }
  throw unreadable("it is of another version of raymoval");
}

std::vector<FolderCell> folder_cells(const ordered_json& record) {
  std::vector<FolderCell> cells;
  if (record.contains("cells")) {
    for (const ordered_json& cell : record.at("cells")) {
      cells.push_back({cell.at("sequence").get<std::string>(), name_of(cell)});
    }
    return cells;
  }
  for (const ordered_json& sequence : record.at("suite").at("sequences")) {
    for (const ordered_json& method : record.at("suite").at("methods")) {
      cells.push_back({name_of(sequence), name_of(method)});
    }
  }
  return cells;
}

std::string why_not_together(const ordered_json& present, const ordered_json& asked) {
  const std::string holds = suite_name_of(present), wanted = suite_name_of(asked);
  if (holds != wanted && holds != kUnnamedSuite && wanted != kUnnamedSuite) {
    return "the folder holds the results of " + suite_words(present) + ", and this is " +
           suite_words(asked) + ".";
  }
  std::string why = why_other_sequences(present, asked);
  if (why.empty()) why = why_other_protocols(present, asked);
  return why.empty() ? why_shared_folder(present, asked) : why;
}

std::string why_other_data(const ordered_json& present, const std::string& sequence,
                           const std::string& fingerprint) {
  const std::string known = known_fingerprint(present, sequence);
  if (known.empty() || known == fingerprint) return "";
  return "the folder holds results on other data called '" + sequence +
         "': its scans, poses or labels differ (fingerprint " + known + ", now " + fingerprint +
         ").";
}

void refuse_other_results(const path& out, const std::string& why) {
  if (why.empty()) return;
  throw UsageError("--out " + out.string() + ": " + why +
                   " Name another folder, or replace the results in this one with --overwrite.");
}

std::string known_fingerprint(const ordered_json& record, const std::string& sequence) {
  const ordered_json* known = find_named(record.at("suite").at("sequences"), sequence);
  return known == nullptr ? "" : known->value("fingerprint", "");
}

bool note_fingerprint(ordered_json& record, const std::string& sequence,
                      const std::string& fingerprint) {
  for (ordered_json& item : record.at("suite").at("sequences")) {
    if (name_of(item) != sequence || item.value("fingerprint", "") == fingerprint) continue;
    item["fingerprint"] = fingerprint;
    return true;
  }
  return false;
}

ordered_json merged_run_record(const ordered_json& present, const ordered_json& asked) {
  ordered_json merged = asked;
  const ordered_json &before = present.at("suite"), &now = asked.at("suite");
  ordered_json& suite = merged.at("suite");
  if (suite_name_of(asked) == kUnnamedSuite) suite["name"] = before.at("name");
  suite["sequences"] = merged_list(before.at("sequences"), now.at("sequences"));
  suite["methods"] = merged_list(before.at("methods"), now.at("methods"));
  suite["controls"] = now.at("controls").get<bool>() || before.at("controls").get<bool>();
  for (const ordered_json& sequence : before.at("sequences")) {
    const std::string known = known_fingerprint(present, name_of(sequence));
    if (!known.empty()) note_fingerprint(merged, name_of(sequence), known);
  }
  merged["cells"] = merged_cells(suite, present, asked);
  merged["places"] = merged_places(suite, present, asked);
  return merged;
}

const ordered_json* EarlierCells::find(const FolderCell& cell) const {
  for (const Kept& one : kept) {
    if (one.cell.sequence == cell.sequence && one.cell.name == cell.name) return one.json.get();
  }
  return nullptr;
}

std::vector<std::string> EarlierCells::lines() const {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < kept.size();) {
    const std::string& sequence = kept[i].cell.sequence;
    std::vector<std::string> names;
    for (; i < kept.size() && kept[i].cell.sequence == sequence; ++i) {
      names.push_back(kept[i].cell.name);
    }
    lines.push_back("kept of earlier runs on " + sequence + ": " + join(names));
  }
  for (const std::string& cell : left_out) {
    lines.push_back("left out of the tables: " + cell + ". Run it again to have it.");
  }
  return lines;
}

EarlierCells read_earlier_cells(const CellStore& store, const ordered_json& record,
                                const ordered_json& asked) {
  std::vector<std::string> wanted;
  for (const FolderCell& cell : folder_cells(asked)) {
    wanted.push_back(cell_text(cell.sequence, cell.name));
  }
  std::sort(wanted.begin(), wanted.end());
  EarlierCells earlier;
  for (const FolderCell& cell : folder_cells(record)) {
    const std::string text = cell_text(cell.sequence, cell.name);
    if (std::binary_search(wanted.begin(), wanted.end(), text)) continue;
    const path file = store.folder(cell.sequence, cell.name) / "cell.json";
    if (!is_there(file)) continue;
    std::string why = "its file is damaged";
    try {
      ordered_json json = read_sealed(file);
      why = why_left_out(json, record, asked.at("suite").at("protocols"));
      if (why.empty()) {
        merge_repeats(json, further_runs(store, cell, json));
        earlier.kept.push_back({cell, std::make_shared<ordered_json>(std::move(json))});
      }
    } catch (const DataError&) {
    } catch (const ordered_json::exception&) {
    }
    if (!why.empty()) {
      earlier.left_out.push_back(cell.sequence + " / " + cell.name + ": " + why);
    }
  }
  return earlier;
}

void merge_repeats(ordered_json& cell, std::vector<Measurement> further) {
  if (further.empty() || cell["status"] != "ok") return;
  std::vector<Measurement> runs = std::move(further);
  runs.insert(runs.begin(), measurement_from(cell["measured"]));
  ordered_json means = ordered_json::array();
  for (const Measurement& run : runs) means.push_back(run.mean_seconds);
  std::stable_sort(runs.begin(), runs.end(),
                   [](const auto& a, const auto& b) { return a.total_seconds < b.total_seconds; });
  cell["measured"] = to_json(runs[(runs.size() - 1) / 2]);
  cell["measured"]["repeats"] = std::move(means);
}

}  // namespace raymoval
