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

/// The source that reads the scans of `sequence` from files, below any source that changes them.
/// Null if the scans are not read from files.
const FileScanSource* stored_files(const Sequence& sequence);

/// The layout of a folder of cleaned scans that opens like the sequence itself.
struct ScanFolderPlan {
  std::filesystem::path root;  ///< The folder of the sequence.
  std::filesystem::path
      scans;  ///< The folder of its scans, relative to `root`; empty if it is `root`.
  /// Files of `root` that are copied, relative to it.
  std::vector<std::filesystem::path> copies;
  /// Whether the folder gets a pose file of its own, with a row for each scan, because rows of the
  /// sequence's file belong to scans that are not written.
  bool own_poses = false;
};

/// Scans of a recording become .pcd files.
/// @throws UsageError for a simulated sequence, for a format that can only be read, or a
///   format that would lose data
ScanFolderPlan plan_scan_folder(const Sequence& sequence);

/// The scans of a sequence without points that were removed or left out. Names, format (binary, not
/// compressed) and all fields stay the same bit for bit. Poses, times and calibration are written
/// as well, and the labels of the remaining points if the sequence has labels. `cleaned.json` lists
/// the files.
class ScanFolder : public CleanOutput {
 public:
  /// @param sequence must outlive this object
  ScanFolder(const std::filesystem::path& path, const Sequence& sequence, ScanFolderPlan plan);

  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { folder_.commit_with(together); }
  /// Scans without a remaining point, and label files that do not fit their scans.
  [[nodiscard]] std::vector<std::string> remarks() const override;

 private:
  void put(const std::filesystem::path& file, std::string_view content);
  void copy(const std::filesystem::path& file);
  void copy_settings(const std::filesystem::path& file);
  void write_labels(const std::filesystem::path& labels, const CleanedScan& scan,
                    const std::vector<std::uint8_t>& keep);

  OutputFolder folder_;
  const Sequence& sequence_;
  ScanFolderPlan plan_;
  std::string pose_rows_;
  std::vector<std::string> files_;
  std::vector<std::string> empty_, unfit_labels_;  ///< Names of scans.
};

}  // namespace raymoval
