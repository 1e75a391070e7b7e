// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/run_folder.h"

#include <algorithm>
#include <array>

#include "benchmark/process/machine.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/result/results.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/folder/cell_store.h"
#include "benchmark/suite/suite_json.h"
#include "benchmark/tables/tables.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

FileLock::State taken(FileLock& lock, FileLock::Mode mode) {
  try {
    return lock.take(mode);
  } catch (const DataError& error) {
    throw DataError(std::string(error.what()) + " Nothing was changed; choose another --out.");
  }
}

using std::filesystem::path;

constexpr const char* kMarkerText =
    "This folder is one of `raymoval run --out`, which replaces its own files here and leaves\n"
    "all others alone.\n";

/// Whether a run writes a file of this name into its folder.
bool is_run_file(const path& name) {
  const std::string text = name.string();
  constexpr std::array kNames = {"run.json", "results.json", "results.csv",
                                 "table.md", "table.tex",    kRunMarker};
  return std::find(kNames.begin(), kNames.end(), text) != kNames.end();
}

bool is_lock(const path& entry) {
  if (entry.filename() != kLockFile || !is_file(entry)) return false;
  const auto start = if_whole([&] { return read_piece(entry, 0, 8); });
  if (!start) return false;  // Its holder removed it.
  return start->empty() || *start == "process ";
}

/// A folder that holds folders only.
bool holds_cells(const path& entry) {
  if (entry.filename() != "cells" || !is_folder(entry)) return false;
  const std::vector<path> inside = entries_of(entry);
  return std::all_of(inside.begin(), inside.end(), is_folder);
}

/// Entries of a run folder without a marker: a run was ended early, or a user copied cells
/// together.
bool may_be_ours(const path& entry) {
  return is_run_file(name_of_part(entry)) || is_lock(entry) || holds_cells(entry);
}

/// Whether a run.json was written by a run and not changed since.
bool is_run_record(const path& file) {
  try {
    (void)read_run_record(file);
  } catch (const UnreadableError&) {
    throw;
  } catch (const SchemaVersionError&) {
    return true;
  } catch (const DataError&) {
    return false;
  }
  return true;
}

/// @throws UsageError for a folder that may not be a run's
void check_is_run_folder(const path& out) {
  if (has_file(out / kRunMarker)) return;
  const std::string where = "--out " + out.string() + ": ";
  const std::string remedy =
      " Nothing was changed. Name a new or empty folder, or that of an earlier run to go on with "
      "it.";
  if (has_file(out / "run.json")) {
    if (is_run_record(out / "run.json")) return;  // Copied without its marker.
    throw UsageError(where + "its run.json is not as raymoval wrote it, so the folder may belong " +
                     "to another program." + remedy);
  }
  for (const path& entry : entries_of(out)) {
    if (may_be_ours(entry)) continue;
    if (has_file(out / kRunMarker)) return;  // Another run has marked the folder meanwhile.
    throw UsageError(where + "the folder holds other files (" + entry.filename().string() +
                     ") and no run." + remedy);
  }
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& file, Mode mode)
    : lock_(file), state_(taken(lock_, mode)) {
  if (state_ != FileLock::State::kBusy) return;
  throw UsageError(file.parent_path().string() + ": another run is writing there (" +
                   lock_.holder() + "). Wait for its end, or choose another --out.");
}

void prepare_run_folder(const path& out) {
  if (has_folder(out)) check_is_run_folder(out);
  make_folder(out);
  if (!has_file(out / kRunMarker)) write_atomically(out / kRunMarker, kMarkerText);
}

void check_run_folder_stays(const path& out) {
  if (has_file(out / kRunMarker)) return;
  throw DataError(
      out.string() +
      ": is no longer the folder of this run; it was moved or removed meanwhile. Finished cells "
      "are in the moved folder: name it with --out, and the same command runs the rest.");
}

bool is_record_of_run(const path& file) {
  const path folder = std::filesystem::absolute(file).lexically_normal().parent_path();
  if (has_file(folder / kRunMarker) || has_file(folder / "run.json")) {
    return is_run_file(file.filename());
  }
  for (path above = folder; above != above.parent_path(); above = above.parent_path()) {
    if (above.filename() == "cells" && has_file(above.parent_path() / "run.json")) return true;
  }
  return false;
}

void sweep_run_folder(const path& out) {
  for (const path& entry : entries_of(out)) {
    std::error_code ignored;
    if (is_run_file(name_of_part(entry))) std::filesystem::remove(entry, ignored);
  }
}

RunRecord run_record(const Suite& suite, const std::vector<Sequence>& sequences, int threads,
                     int jobs) {
  RunRecord run{suite.name};
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    run.sequences.push_back({sequences[i].record(), absolute_place(suite.sequences[i])});
  }
  for (const MethodRequest& request : suite.methods) {
    run.methods.push_back({request.name, request.method.full_name(), request.method.entry->version,
                           request.method.configuration});
    SuiteMethodRecord& method = run.methods.back();
    if (!request.sweep.empty()) method.sweep = SweepRecord{request.sweep_of, request.sweep};
    if (Configuration changed = request.changed_from(); !changed.empty()) {
      method.changed_from = std::move(changed);
    }
  }
  for (const ProtocolRequest& request : suite.protocols) {
    run.protocols.push_back({request.name, request.protocol,
                             protocol_entry(request.protocol).version, request.options});
  }
  run.controls = suite.controls;
  run.cells = run.all_cells();
  run.build = build_record();
  run.machine = machine_record(threads);
  if (jobs > 1) run.machine->jobs = jobs;
  return run;
}

void write_result_files(const path& out, const ResultsRecord& results) {
  const RunResults shown = shown_results(results);
  write_atomically(out / "results.csv", results_csv(shown));
  write_atomically(out / "table.md", tables_markdown(shown, make_tables(shown)));
  write_atomically(out / "table.tex",
                   tables_latex(make_tables(shown, {.what = latex_kinds(shown)})));
  write_results(out / "results.json", results);
}

}  // namespace raymoval
