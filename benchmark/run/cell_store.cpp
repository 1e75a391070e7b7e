// SPDX-License-Identifier: MIT
#include "benchmark/run/cell_store.h"

#include <nlohmann/json.hpp>
#include <system_error>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/cell.h"
#include "benchmark/result/removal_files.h"
#include "benchmark/result/sealed_json.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/part_name.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;
using std::filesystem::path;

constexpr const char* kRemovals = "removals";

path repeat_file(const path& folder, int number) {
  return folder / ("timing-" + std::to_string(number) + ".json");
}

/// Whether the kept removals are those that the cell was scored by.
bool has_removals(const path& folder, const ordered_json& cell, const ScanSource& scans) {
  try {
    const MaskStore masks = read_removals(folder / kRemovals, scans, [] {});
    return mask_digest(masks) == cell.at("masks").at("digest");
  } catch (const DataError&) {
    return false;
  }
}

/// What a result file says about itself, without the repetition of its path and the remedy.
std::string damage(const path& file) {
  return file.filename().string() + " is damaged or was changed by hand";
}

/// Whether a run writes files of this name into a cell's folder.
bool is_cell_file(const path& name) {
  return name == "cell.json" ||
         (name.string().starts_with("timing-") && name.extension() == ".json");
}

/// What a killed run left in a cell's folder. Names that only runs give, nothing else.
void sweep_cell(const path& folder) {
  for (const path& entry : entries_of(folder)) {
    const path name = name_of_part(entry);
    // The second is what earlier versions left.
    if (name == kRemovals || entry.filename() == "removals.part") remove_removals(entry);
    std::error_code ignored;
    if (is_cell_file(name)) std::filesystem::remove(entry, ignored);
  }
}

}  // namespace

void make_folder(const path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw DataError(folder.string() + ": cannot be made (" + error.message() +
                    "). Choose another --out.");
  }
}

path CellStore::folder(const std::string& sequence, const std::string& name) const {
  return out_ / "cells" / folder_name(sequence) / folder_name(name);
}

path CellStore::new_removals(const path& folder) const {
  return new_part_name(folder / kRemovals);
}

StoredCell CellStore::find(SequenceBench& bench, const MethodRequest& request,
                           bool with_removals) const {
  using State = StoredCell::State;
  const path place = folder(bench.sequence().name, request);
  const path file = place / "cell.json";
  if (!has_file(file)) return {State::kMissing, "is not there yet", {}};
  try {
    auto cell = std::make_shared<ordered_json>(read_sealed(file));
    const auto status = cell->at("status").get<std::string>();
    const bool same = cell->value("key", ordered_json()) == cell_key(bench, request);
    if (status != "ok") {
      const std::string why = "failed last time: " + cell->at("reason").get<std::string>();
      return {same ? State::kFailed : State::kStale, why, same ? cell : nullptr};
    }
    if (!same) {
      return {State::kStale, identity_difference(*cell, cell_identity(bench, request)), nullptr};
    }
    if (with_removals && !has_removals(place, *cell, *bench.sequence().scans)) {
      return {State::kStale, "its removals are asked for and not there, or not whole", nullptr};
    }
    return {State::kFresh, "", cell};
  } catch (const DataError&) {
    return {State::kStale, damage(file), nullptr};
  } catch (const ordered_json::exception&) {
    return {State::kStale, damage(file), nullptr};
  }
}

std::optional<StoredRepeat> CellStore::find_repeat(const std::string& sequence,
                                                   const std::string& name, int number,
                                                   const std::string& key) const {
  try {
    const ordered_json json = read_sealed(repeat_file(folder(sequence, name), number));
    if (json.at("key") != key) return std::nullopt;
    return StoredRepeat{json.at("digest").get<std::string>(),
                        measurement_from(json.at("measured"))};
  } catch (const DataError&) {
    return std::nullopt;
  } catch (const ordered_json::exception&) {
    return std::nullopt;
  }
}

void CellStore::prepare(const path& folder) const {
  make_folder(folder);
  sweep_cell(folder);
}

void CellStore::keep(const path& folder, const ordered_json& cell, const path& removals) const {
  const path place = folder / kRemovals;
  std::error_code error;
  const bool has = !removals.empty() && has_folder(removals);
  if (has || is_there(place)) {
    // A cell never stands beside removals of another one.
    std::filesystem::remove(folder / "cell.json", error);
    if (!remove_removals(place)) {
      throw DataError(place.string() +
                      ": holds files that no run writes, so it is not replaced. Move them away.");
    }
  }
  if (has) {
    std::filesystem::rename(removals, place, error);
    if (error) throw DataError(place.string() + ": cannot be made (" + error.message() + ").");
  }
  write_sealed(folder / "cell.json", cell);
}

void CellStore::keep_repeat(const path& folder, int number, const std::string& key,
                            const StoredRepeat& repeat) const {
  ordered_json json;
  json["schema_version"] = kSchemaVersion;
  json["key"] = key;
  json["repeat"] = number;
  json["digest"] = repeat.digest;
  json["measured"] = to_json(repeat.measured);
  write_sealed(repeat_file(folder, number), std::move(json));
}

void CellStore::sweep() const {
  if (!has_folder(out_ / "cells")) return;
  for (const path& sequence : folders_in(out_ / "cells")) {
    for (const path& cell : folders_in(sequence)) sweep_cell(cell);
  }
}

}  // namespace raymoval
