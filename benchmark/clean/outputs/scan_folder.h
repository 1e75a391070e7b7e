// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "benchmark/clean/outputs/clean_output.h"
#include "benchmark/clean/outputs/output_folder.h"
#include "datasets/sequence.h"

namespace raymoval {

class FileScanSource;

/// The files that the scans of `sequence` are stored in, whatever is done with them when they are
/// read. Null if they are not read from files.
const FileScanSource* stored_files(const Sequence& sequence);

/// How the cleaned scans of a sequence are laid out in a folder, so that it opens as the sequence
/// does.
struct ScanFolderPlan {
  std::filesystem::path root;   ///< The folder of the sequence.
  std::filesystem::path scans;  ///< Where in it its scans stand; empty if right in it.
  /// Files of `root` that are copied, relative to it.
  std::vector<std::filesystem::path> copies;
  /// Whether the folder gets a pose file of its own, with a row for each scan, because rows of the
  /// sequence's file belong to scans that are not written.
  bool own_poses = false;
};

/// Scans of a recording become .pcd files.
/// @throws UsageError naming what cannot be written: a simulated sequence, or a format that is only
///   read, or that would lose something
ScanFolderPlan plan_scan_folder(const Sequence& sequence);

/// The scans of a sequence without the points that were removed or left out: the same names, the
/// same format (binary and not compressed), all fields bit for bit, with their poses, times and
/// calibration, and labels of the points that are left where the sequence has labels.
/// `cleaned.json` lists the files.
class ScanFolder : public CleanOutput {
 public:
  /// @param sequence must outlive this object
  ScanFolder(const std::filesystem::path& path, const Sequence& sequence, ScanFolderPlan plan);

  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { folder_.commit_with(together); }
  /// Names of scans of which no point is left, which no reader takes.
  [[nodiscard]] const std::vector<std::string>& empty_scans() const { return empty_; }

 private:
  void put(const std::filesystem::path& file, std::string_view content);
  void copy(const std::filesystem::path& file);
  void copy_settings(const std::filesystem::path& file);
  void write_labels(const std::filesystem::path& labels, const std::vector<std::uint8_t>& keep);

  OutputFolder folder_;
  const Sequence& sequence_;
  ScanFolderPlan plan_;
  std::string pose_rows_;
  std::vector<std::string> files_, empty_;
};

}  // namespace raymoval
