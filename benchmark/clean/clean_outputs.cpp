// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_outputs.h"

#include <algorithm>

#include "benchmark/clean/outputs/map_output.h"
#include "benchmark/clean/outputs/map_views.h"
#include "benchmark/clean/outputs/output_folder.h"
#include "benchmark/clean/outputs/scan_folder.h"
#include "benchmark/clean/rows/map_rows.h"
#include "benchmark/picture/maps/map_picture.h"
#include "benchmark/result/removals/removal_files.h"
#include "core/error.h"
#include "core/scan/local_frame.h"

namespace raymoval {
namespace {

/// A label file for each scan: 251 = removed, 9 = kept, 0 = in no output.
class LabelFolder : public CleanOutput {
 public:
  explicit LabelFolder(const std::filesystem::path& path) : folder_(path) {}
  void add(const CleanedScan& scan) override {
    write_removal(folder_.place(), scan.scan, scan.mask);
  }
  void finish() override {}
  void commit_with(Replacements& together) override { folder_.commit_with(together); }

 private:
  OutputFolder folder_;
};

bool is_map(const OutputPath& output) {
  return output.kind == OutputKind::kCloud;
}

MapContent content_of(const OutputPath& output) {
  if (output.option == "--dynamic") return {false, true, false};
  if (output.option == "--labelled") return {true, true, true};
  return {};
}

/// @throws UsageError if the confidence is requested but no output can hold it
void check_confidence(const std::vector<OutputPath>& outputs, const CleanWriting& writing) {
  if (!writing.confidence || std::any_of(outputs.begin(), outputs.end(), is_map)) return;
  throw UsageError(
      "--confidence has no effect: it is a field of maps, and none is written. Name one with -o, "
      "or with --labelled to have all points; or leave it out.");
}

}  // namespace

CleanOutputs::CleanOutputs(const CleanPaths& paths, const CleanWriting& writing,
                           const Sequence& sequence, Progress& progress,
                           const std::atomic<bool>& cancel)
    : sequence_(sequence) {
  const std::vector<OutputPath> all = paths.all();
  check_confidence(all, writing);
  const MapPrecision precision = map_precision(*sequence.scans);
  const bool needs_rows = std::any_of(all.begin(), all.end(), [](const OutputPath& output) {
    return output.kind != OutputKind::kLabels;
  });
  std::optional<ScanFolderPlan> plan;
  if (!paths.scans.empty()) plan = plan_scan_folder(sequence);
  if (needs_rows) {
    rows_.emplace(sequence, precision.coordinates, progress, cancel);
    layout_ = writing.confidence ? layout_with_confidence(rows_->layout()) : rows_->layout();
    has_confidence_ = writing.confidence;
  }
  for (const OutputPath& output : all) {
    if (is_map(output)) add_map(output, writing, precision.origin);
  }
  if (rows_ && rows_->is_widened() && first_map_ != nullptr) {
    notes_.push_back(
        "The map lies more than 8 km from the world's origin: its coordinates are float64.");
  }
  if (!paths.labels.empty()) outputs_.push_back(std::make_unique<LabelFolder>(paths.labels));
  if (plan) {
    has_own_poses_ = plan->own_poses;
    outputs_.push_back(std::make_unique<ScanFolder>(paths.scans, sequence, std::move(*plan)));
  }
  add_views(paths, writing);
}

void CleanOutputs::note_losses(const OutputPath& output, const RecordLayout& layout) {
  for (const std::string& lost : format_losses(output.path, layout)) {
    notes_.push_back(output.option + ": " + lost);
  }
}

void CleanOutputs::add_map(const OutputPath& output, const CleanWriting& writing,
                           const Eigen::Vector3d& voxel_origin) {
  const MapContent content = content_of(output);
  const RecordLayout layout = content.labelled ? labelled_layout(layout_) : layout_;
  if (rows_->is_widened()) check_coordinates(output.path, Coordinates::kDouble);
  note_losses(output, layout);
  auto map =
      std::make_unique<MapOutput>(output.path, layout_, content, writing.voxel_size, voxel_origin);
  if (first_map_ == nullptr) first_map_ = map.get();
  outputs_.push_back(std::move(map));
}

void CleanOutputs::add_views(const CleanPaths& paths, const CleanWriting& writing) {
  const ViewTexts texts{sequence_.name, writing.method, !sequence_.made_poses.empty()};
  if (!paths.page.empty()) {
    outputs_.push_back(std::make_unique<MapPageFile>(paths.page, texts, sequence_.upright_frame()));
  }
  if (paths.picture.empty()) return;
  const LocalFrameSource upright(*sequence_.scans, sequence_.upright_frame());
  outputs_.push_back(std::make_unique<MapPictureFile>(
      paths.picture, texts, sequence_.upright_frame(), window_around_way(upright)));
}

void CleanOutputs::add(const Scan& scan, const Mask& mask, const std::string& confidence) {
  std::optional<PointRecords> stored;
  if (sequence_.records != nullptr && rows_) stored = sequence_.records->records(scan.index);
  const PointRecords* records = stored ? &*stored : nullptr;
  ScanRows rows = rows_ ? rows_->rows(scan, records) : ScanRows{};
  if (has_confidence_) rows = rows_with_confidence(rows, layout_, confidence);
  const CleanedScan cleaned{scan, mask, rows, records, confidence};
  for (const auto& output : outputs_) output->add(cleaned);
}

void CleanOutputs::commit() {
  for (const auto& output : outputs_) output->finish();
  Replacements all;
  // The map comes last: where it is, the others are.
  for (auto output = outputs_.rbegin(); output != outputs_.rend(); ++output) {
    (*output)->commit_with(all);
  }
  all.commit();
}

std::optional<std::uint64_t> CleanOutputs::map_points() const {
  if (first_map_ == nullptr) return std::nullopt;
  return first_map_->points();
}

std::vector<std::string> CleanOutputs::results() const {
  std::vector<std::string> results;
  for (const auto& output : outputs_) {
    const std::vector<std::string> remarks = output->remarks();
    results.insert(results.end(), remarks.begin(), remarks.end());
  }
  return results;
}

}  // namespace raymoval
