// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_paths.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "benchmark/clean/outputs/scan_folder.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// The normal form of a path, so that two paths can be compared.
fs::path plain(const fs::path& path) {
  std::error_code error;
  fs::path whole = fs::absolute(path, error);
  if (!error) whole = fs::weakly_canonical(whole, error);
  if (error) throw_inaccessible(path, error.value());
  return without_slash(whole);
}

/// Whether `path` is `folder` or is within it at any depth. Both paths are results of `plain`.
bool is_within(const fs::path& path, const fs::path& folder) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

std::vector<std::string> extensions_of(OutputKind kind) {
  if (kind == OutputKind::kPicture) return {".png"};
  if (kind == OutputKind::kPage) return {".html", ".htm"};
  return written_extensions();
}

void check_file(const OutputPath& output, bool overwrite) {
  const fs::path& path = output.path;
  const std::vector<std::string> known = extensions_of(output.kind);
  if (std::find(known.begin(), known.end(), path.extension().string()) == known.end()) {
    throw UsageError(path.string() + ": expected a file name that ends in " + join(known) + ".");
  }
  check_output_file(path, overwrite, path.string());
}

/// The files that the record of an output folder lists, relative to it; nothing if it has no
/// readable record.
std::optional<std::set<std::string>> recorded_files(const fs::path& folder, OutputKind kind) {
  return if_whole([&] {
    std::set<std::string> files = {record_name(kind)};
    const auto record =
        nlohmann::json::parse(read_text(folder / record_name(kind)), nullptr, false);
    if (!record.is_object() || !record.contains("written_by") || !record.contains("files") ||
        !record["files"].is_array()) {
      throw DataError("no record");
    }
    for (const auto& name : record["files"]) {
      if (name.is_string()) files.insert(name.get<std::string>());
    }
    return files;
  });
}

/// Whether an earlier run wrote this entry of its output folder.
bool is_ours(const fs::path& entry, const fs::path& folder, OutputKind kind,
             const std::optional<std::set<std::string>>& recorded) {
  if (kind == OutputKind::kLabels) return entry.extension() == ".label" && is_file(entry);
  if (!recorded) return false;
  return fs::is_directory(fs::symlink_status(entry)) ||
         recorded->contains(entry.lexically_relative(folder).string());
}

void check_folder(const OutputPath& output, bool overwrite) {
  const fs::path& path = output.path;
  const fs::path ending = path.extension();
  if (output.kind == OutputKind::kScans &&
      (ending == ".bag" || ending == ".mcap" || ending == ".db3")) {
    throw UsageError(path.string() +
                     ": recordings are not written. Name a folder with --scans, which gets a .pcd "
                     "file for each scan and a pose file.");
  }
  if (!is_there(path)) return;
  if (!is_folder(path)) {
    throw UsageError(path.string() + ": is not a folder; " + output.option +
                     " writes several files into one.");
  }
  const std::vector<fs::path> entries = entries_of(path);
  if (entries.empty()) return;
  if (!overwrite) {
    throw UsageError(
        path.string() + ": holds " + entries.front().filename().string() +
        " already; choose a new folder, or replace the output of an earlier run with --overwrite.");
  }
  std::optional<std::set<std::string>> recorded;
  if (output.kind != OutputKind::kLabels) recorded = recorded_files(path, output.kind);
  std::vector<fs::path> all = entries;
  if (output.kind != OutputKind::kLabels) {
    all.assign(fs::recursive_directory_iterator(path), {});
  }
  for (const fs::path& entry : all) {
    if (is_ours(entry, path, output.kind, recorded)) continue;
    throw UsageError(entry.string() +
                     (output.kind == OutputKind::kLabels
                          ? ": is not a label file"
                          : ": was not written by `clean " + output.option + "`") +
                     ", and --overwrite replaces the whole folder; choose a new one.");
  }
}

void check_inputs_stay(const std::vector<fs::path>& inputs,
                       const std::vector<OutputPath>& outputs) {
  std::set<std::pair<dev_t, ino_t>> identities;
  std::set<fs::path> folders;
  for (const fs::path& input : inputs) {
    if (const auto identity = identity_of(input)) identities.insert(*identity);
    folders.insert(plain(input).parent_path());
  }
  for (const OutputPath& output : outputs) {
    const auto identity = identity_of(output.path);
    const fs::path path = plain(output.path);
    const bool around = is_folder_output(output.kind) &&
                        std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) {
                          return is_within(folder, path);
                        });
    if (!around && !(identity && identities.contains(*identity))) continue;
    throw UsageError(output.path.string() + ": is read as an input" +
                     (around ? ", or holds one" : "") + "; choose another place for " +
                     output.option + ".");
  }
}

}  // namespace

std::vector<fs::path> files_of(const Sequence& sequence) {
  std::vector<fs::path> files = sequence.input_files;
  if (const FileScanSource* source = stored_files(sequence)) {
    for (const FrameEntry& frame : source->frames()) {
      files.push_back(frame.path);
      if (!frame.label_path.empty()) files.push_back(frame.label_path);
    }
  }
  return files;
}

bool is_folder_output(OutputKind kind) {
  return kind == OutputKind::kLabels || kind == OutputKind::kScans;
}

std::vector<OutputPath> CleanPaths::all() const {
  const OutputKind maps = OutputKind::kCloud;
  std::vector<OutputPath> outputs = {{"-o", map, maps},
                                     {"--dynamic", removed, maps},
                                     {"--labels", labels, OutputKind::kLabels},
                                     {"--scans", scans, OutputKind::kScans},
                                     {"--html", page, OutputKind::kPage},
                                     {"--picture", picture, OutputKind::kPicture}};
  std::erase_if(outputs, [](const OutputPath& output) { return output.path.empty(); });
  return outputs;
}

const char* record_name(OutputKind kind) {
  return kind == OutputKind::kScans ? "cleaned.json" : "";
}

void check_paths(const CleanPaths& paths) {
  const std::vector<OutputPath> outputs = paths.all();
  for (const OutputPath& output : outputs) {
    if (is_folder_output(output.kind)) {
      check_folder(output, paths.overwrite);
    } else {
      check_file(output, paths.overwrite);
    }
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const fs::path first = plain(outputs[i].path);
    for (std::size_t k = i + 1; k < outputs.size(); ++k) {
      const fs::path second = plain(outputs[k].path);
      const std::string both = outputs[i].option + " and " + outputs[k].option;
      const auto identity = identity_of(first);
      if (first == second || (identity && identity == identity_of(second))) {
        throw UsageError(both + " name the same file.");
      }
      if (is_within(first, second) || is_within(second, first)) {
        throw UsageError(both + " name nested folders; choose two that are not inside each other.");
      }
    }
  }
}

void check_apart_from(const Sequence& sequence, const CleanPaths& paths,
                      const std::vector<fs::path>& inputs) {
  std::vector<fs::path> all = files_of(sequence);
  all.insert(all.end(), inputs.begin(), inputs.end());
  const std::vector<OutputPath> outputs = paths.all();
  const FileScanSource* files = stored_files(sequence);
  if (files != nullptr && !files->frames().empty()) {
    const fs::path scans = plain(files->frames().front().path).parent_path();
    for (const OutputPath& output : outputs) {
      const fs::path path = plain(output.path);
      if (output.kind == OutputKind::kCloud && path.parent_path() == scans) {
        throw UsageError(
            output.path.string() +
            ": is in the folder of the scans and would be read as a scan; choose another folder.");
      }
      if (output.kind != OutputKind::kLabels) continue;
      if (path == scans || path == scans / "labels" || path == scans.parent_path() / "labels") {
        throw UsageError(
            output.path.string() +
            ": is the folder of the ground-truth labels of the sequence; choose another folder.");
      }
    }
  }
  check_inputs_stay(all, outputs);
}

}  // namespace raymoval
