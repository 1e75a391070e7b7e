// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/scan_folder.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/frames.h"
#include "datasets/layouts.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSettings = "sequence.json";
constexpr const char* kOwnPoses = "poses.txt";

/// Settings of poses and frames, which the folder's own pose file replaces.
constexpr std::array kPoseSettings = {"poses",       "frames",    "T_sensor",       "time_offset_s",
                                      "pose_format", "max_gap_s", "poses_are_lidar"};

/// `path` relative to `root`; nothing if it is outside `root`.
std::optional<fs::path> relative_to(const fs::path& path, const fs::path& root) {
  const fs::path relative =
      fs::weakly_canonical(path).lexically_relative(fs::weakly_canonical(root));
  if (relative.empty() || *relative.begin() == ".." || relative.is_absolute()) return std::nullopt;
  return relative;
}

/// The file name of a cleaned scan: that of the scan. A scan of an archive becomes an
/// array, and a scan without a file becomes a .pcd file.
fs::path written_name(const FileScanSource* files, const Scan& scan) {
  if (files == nullptr) return scan.name + ".pcd";
  const fs::path& path = files->frames()[scan.index].path;
  const std::string extension = cloud_extension(path);
  return cloud_stem(path) + (extension == ".npz" ? ".npy" : extension);
}

/// All scans of a sequence have one format, and the same fields.
void check_format(const fs::path& file, const RecordLayout& layout) {
  const std::vector<std::string> lost = format_losses(file, layout);
  if (lost.empty()) return;
  throw UsageError("--scans cannot write the scans as they are: " + join(lost, " ") +
                   " Write a map with -o, which may have another format.");
}

std::vector<fs::path> side_files(const Sequence& sequence, const fs::path& root) {
  std::vector<fs::path> candidates = sequence.input_files;
  for (const std::string& name :
       {sequence.poses_file, std::string("calib.txt"), std::string("times.txt"),
        std::string("timestamps.txt"), std::string(kSettings)}) {
    if (!name.empty() && is_there(root / name)) candidates.push_back(root / name);
  }
  std::vector<fs::path> files;
  for (const fs::path& candidate : candidates) {
    const auto relative = relative_to(candidate, root);
    if (relative && is_file(candidate)) files.push_back(*relative);
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// @param origin of the sensor in the frame of the stored points, which the row is of
std::string pose_row(const Scan& scan, const Eigen::Vector3d& origin) {
  const Eigen::Quaterniond turn(scan.T_world_sensor.linear());
  const Eigen::Vector3d at = scan.T_world_sensor * -origin;
  std::string row = number_text(scan.time_s);
  for (const double value : {at.x(), at.y(), at.z(), turn.x(), turn.y(), turn.z(), turn.w()}) {
    row += ' ' + number_text(value);
  }
  return row + '\n';
}

std::vector<std::uint8_t> kept_rows(const CleanedScan& scan) {
  std::vector<std::uint8_t> keep(scan.stored->size(), 0);
  for (std::size_t i = 0; i < scan.mask.size(); ++i) {
    if (scan.mask[i] == 0) keep[scan.scan.stored_position(i)] = 1;
  }
  return keep;
}

}  // namespace

const FileScanSource* stored_files(const Sequence& sequence) {
  const auto* files = dynamic_cast<const FileScanSource*>(sequence.records.get());
  return files != nullptr ? files : file_source(sequence);
}

ScanFolderPlan plan_scan_folder(const Sequence& sequence) {
  const FileScanSource* source = stored_files(sequence);
  if (sequence.records == nullptr) {
    throw UsageError("--scans writes scans in the format in which they are stored, but those of '" +
                     sequence.name +
                     "' are not stored in files of their own. Write a map with -o.");
  }
  Scan first;
  first.name = "000000";
  check_format(written_name(source, first), sequence.records->layout(0));
  ScanFolderPlan plan;
  if (source == nullptr) {  // A recording.
    plan.own_poses = true;
    return plan;
  }
  plan.root = source->frames().front().path.parent_path();
  if (!layout_of(sequence).scan_folder.empty()) {
    plan.scans = plan.root.filename();
    plan.root = plan.root.parent_path();
  }
  plan.copies = side_files(sequence, plan.root);
  const std::size_t stored = list_files(plan.root / plan.scans, cloud_extensions()).size();
  plan.own_poses =
      !sequence.made_poses.empty() || (sequence.layout == "files" && stored != source->size());
  // Beside their poses, scans of any layout are a plain folder of scans.
  if (!sequence.made_poses.empty()) plan.scans.clear();
  return plan;
}

ScanFolder::ScanFolder(const fs::path& path, const Sequence& sequence, ScanFolderPlan plan)
    : folder_(path), sequence_(sequence), plan_(std::move(plan)) {
  for (const fs::path& file : plan_.copies) {
    if (file == kSettings) {
      copy_settings(file);
    } else if (!plan_.own_poses) {
      copy(file);
    }
  }
}

void ScanFolder::put(const fs::path& file, std::string_view content) {
  (void)make_folders((folder_.place() / file).parent_path());  // An error shows when it is written.
  write_atomically(folder_.place() / file, content);
  files_.push_back(file.string());
}

void ScanFolder::copy(const fs::path& file) {
  const std::vector<std::byte> bytes = read_bytes(plan_.root / file);
  put(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void ScanFolder::copy_settings(const fs::path& file) {
  if (!plan_.own_poses) return copy(file);
  nlohmann::json settings = read_json(plan_.root / file);
  for (const char* key : kPoseSettings) settings.erase(key);
  put(file, settings.dump(2) + "\n");
}

void ScanFolder::write_labels(const fs::path& labels, const CleanedScan& scan,
                              const std::vector<std::uint8_t>& keep) {
  const std::vector<std::byte> words = read_bytes(labels);
  const auto relative = relative_to(labels, plan_.root);
  if (!relative) return;
  if (words.size() != keep.size() * sizeof(std::uint32_t)) {
    unfit_labels_.push_back(scan.scan.name);
    return;
  }
  std::string kept;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i] == 0) continue;
    kept.append(reinterpret_cast<const char*>(words.data()) + i * sizeof(std::uint32_t),
                sizeof(std::uint32_t));
  }
  put(*relative, kept);
}

void ScanFolder::add(const CleanedScan& scan) {
  const FileScanSource* files = stored_files(sequence_);
  const std::vector<std::uint8_t> keep = kept_rows(scan);
  const PointRecords kept = scan.stored->chosen(keep);
  if (kept.size() == 0) empty_.push_back(scan.scan.name);
  const fs::path name = plan_.scans / written_name(files, scan.scan);
  put(name, whole_file(name, kept));
  if (files != nullptr && !files->frames()[scan.scan.index].label_path.empty()) {
    write_labels(files->frames()[scan.scan.index].label_path, scan, keep);
  }
  pose_rows_ += pose_row(scan.scan, sequence_.sensor_origin.value_or(SensorPlaces()).one);
}

std::vector<std::string> ScanFolder::remarks() const {
  const auto of_scans = [](const std::vector<std::string>& names) {
    return counted_text(names.size(), "scan") + " (" + names.front() +
           (names.size() > 1 ? ", ...)" : ")");
  };
  std::vector<std::string> remarks;
  if (!empty_.empty()) {
    remarks.push_back("No point is left of " + of_scans(empty_) +
                      ", which some programs cannot read.");
  }
  if (!unfit_labels_.empty()) {
    remarks.push_back("The labels of " + of_scans(unfit_labels_) +
                      " were not written: their number is not that of the points.");
  }
  return remarks;
}

void ScanFolder::finish() {
  if (plan_.own_poses) put(kOwnPoses, pose_rows_);
  nlohmann::ordered_json record;
  record["written_by"] = "raymoval clean --scans";
  record["version"] = 1;
  record["files"] = files_;
  write_atomically(folder_.place() / "cleaned.json", record.dump(2) + "\n");
}

}  // namespace raymoval
