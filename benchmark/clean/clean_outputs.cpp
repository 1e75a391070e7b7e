// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_outputs.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "benchmark/result/removals/removal_files.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/ego/ego_free_source.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// The one way to write a path, so that two can be compared.
fs::path plain(const fs::path& path) {
  std::error_code error;
  fs::path whole = fs::absolute(path, error);
  if (!error) whole = fs::weakly_canonical(whole, error);
  if (error) {
    throw UnreadableError(path.string() + ": cannot be looked at (" + error.message() + ").");
  }
  return without_slash(whole);
}

void check_cloud_path(const fs::path& path, bool overwrite) {
  const std::vector<std::string>& known = cloud_extensions();
  if (std::find(known.begin(), known.end(), path.extension().string()) == known.end()) {
    throw UsageError(path.string() + ": expected a file name that ends in " + join(known) + ".");
  }
  check_folder_of(path);
  const FileKind there = file_kind(path);
  if (there == FileKind::kFolder) {
    throw UsageError(path.string() + ": is a folder, expected a file name.");
  }
  if (there == FileKind::kFile && !overwrite) {
    throw UsageError(path.string() +
                     ": is there already; choose another name, or replace it with --overwrite.");
  }
}

void check_label_folder(const fs::path& path, bool overwrite) {
  if (!is_there(path)) return;
  if (!is_folder(path)) {
    throw UsageError(path.string() + ": is no folder; --labels writes a file per scan into one.");
  }
  for (const fs::path& entry : entries_of(path)) {
    if (!overwrite) {
      throw UsageError(path.string() + ": holds " + entry.filename().string() +
                       " already; choose a new folder, or replace its label files with "
                       "--overwrite.");
    }
    if (entry.extension() != ".label" || !is_file(entry)) {
      throw UsageError(entry.string() +
                       ": is no label file, and --overwrite replaces the whole folder; choose a "
                       "new one.");
    }
  }
}

}  // namespace

void check_paths(const CleanPaths& paths) {
  check_cloud_path(paths.map, paths.overwrite);
  if (!paths.removed.empty()) {
    check_cloud_path(paths.removed, paths.overwrite);
    if (plain(paths.map) == plain(paths.removed)) {
      throw UsageError("-o and --dynamic name the same file.");
    }
  }
  if (!paths.labels.empty()) check_label_folder(paths.labels, paths.overwrite);
}

void check_apart_from(const Sequence& sequence, const CleanPaths& paths) {
  const auto* files = file_source(sequence);
  if (files == nullptr || files->frames().empty()) return;
  const FrameEntry& frame = files->frames().front();
  const fs::path scans = plain(frame.path).parent_path();
  for (const fs::path& path : {paths.map, paths.removed}) {
    if (path.empty() || plain(path).parent_path() != scans) continue;
    throw UsageError(path.string() +
                     ": lies among the scans of the sequence and would be taken for one of them; "
                     "choose another folder.");
  }
  if (paths.labels.empty()) return;
  const fs::path labels = plain(paths.labels);
  if (labels == scans || labels == scans / "labels" || labels == scans.parent_path() / "labels") {
    throw UsageError(paths.labels.string() +
                     ": is where the sequence's own labels stand, which are the truth; choose "
                     "another folder.");
  }
}

LabelFolder::LabelFolder(const fs::path& path) : path_(plain(path)) {
  std::error_code above;  // Shows when the folder is made.
  fs::create_directories(folder_of(path_), above);
  part_ = new_part_folder(path_);
  if (part_.held.valid()) return;
  throw DataError(path_.string() + ": cannot be made (" + std::generic_category().message(errno) +
                  "). Nothing was changed; choose another folder.");
}

LabelFolder::~LabelFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(part_.place, ignored);
}

void LabelFolder::add(const Scan& scan, const Mask& mask) {
  write_removal(part_.place, scan, mask);
}

void LabelFolder::commit_with(Replacements& together) {
  sync_folder(part_.place);
  together.add(std::move(part_), path_);
  committed_ = true;
}

CleanOutputs::CleanOutputs(const CleanPaths& paths, double voxel_size,
                           const MapPrecision& precision)
    : map_(paths.map, voxel_size, precision) {
  if (!paths.removed.empty()) removed_.emplace(paths.removed, voxel_size, precision);
  if (!paths.labels.empty()) labels_.emplace(paths.labels);
}

void CleanOutputs::add(const Scan& scan, const Mask& mask) {
  map_.add(scan, mask, 0);
  if (removed_) removed_->add(scan, mask, 1);
  if (labels_) labels_->add(scan, mask);
}

void CleanOutputs::commit() {
  map_points_ = map_.finish();
  if (removed_) removed_->finish();
  Replacements all;
  if (labels_) labels_->commit_with(all);
  if (removed_) removed_->commit_with(all);
  map_.commit_with(all);
  all.commit();
}

}  // namespace raymoval
