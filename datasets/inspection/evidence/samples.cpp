// SPDX-License-Identifier: MIT
#include "datasets/inspection/evidence/samples.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/sampling.h"
#include "core/text.h"

namespace raymoval::inspection {
namespace {

constexpr std::size_t kReferences = 6;
/// Distances in scans: near enough to overlap, far enough that a slow sensor has moved.
constexpr std::size_t kSteps[] = {1, 3, 8};

}  // namespace

Samples::Samples(const Sequence& sequence, int threads, const std::atomic<bool>* cancel)
    : sequence_(sequence), threads_(threads), cancel_(cancel), layout_(layout_of(sequence)) {
  if (const FileScanSource* files = file_source(sequence)) {
    files_ = files->frames();
  }
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    poses_.push_back(sequence.scans->pose(i));
  }
  choose_pairs();
  read_scans();
  measure_range();
  settle_point_unit();
}

void Samples::choose_pairs() {
  const std::size_t count = poses_.size();
  std::set<std::pair<std::size_t, std::size_t>> chosen;
  for (const std::size_t step : kSteps) {
    if (step >= count) continue;
    for (const std::size_t from : evenly_spread(count - step, kReferences)) {
      chosen.emplace(from, from + step);
    }
  }
  for (const auto& [from, to] : chosen) pairs_.push_back({from, to});
}

void Samples::read_scans() {
  std::set<std::size_t> wanted;
  if (!poses_.empty()) wanted = {0, poses_.size() / 2, poses_.size() - 1};
  for (const ScanPair& pair : pairs_) {
    wanted.insert(pair.from);
    wanted.insert(pair.to);
  }
  for (const std::size_t scan : wanted) {
    throw_if_cancelled(cancel_);
    Scan read = sequence_.scans->load(scan);
    if (!read.points.empty()) scans_.emplace(scan, std::move(read));
  }
  if (scans_.empty()) {
    throw DataError(scan_name(*wanted.begin()) +
                    ": holds no point, nor do the other scans that were looked at; expected points "
                    "in most scans. Copy them again.");
  }
  std::erase_if(pairs_, [&](const ScanPair& pair) {
    return scans_.count(pair.from) == 0 || scans_.count(pair.to) == 0;
  });
}

void Samples::measure_range() {
  std::vector<double> ranges;
  for (const auto& [index, scan] : scans_) {
    const std::size_t step = std::max<std::size_t>(1, scan.size() / 1000);
    for (std::size_t i = 0; i < scan.size(); i += step) {
      // In a world frame, a wrong pose shifts all points; the spread around their middle does not
      // depend on it.
      ranges.push_back(static_cast<double>((scan.points[i] - scan.points[scan.size() / 2]).norm()));
    }
  }
  if (ranges.empty()) return;
  median_range_ = median(std::move(ranges));
}

void Samples::settle_point_unit() {
  // No sensor on the ground has half of its returns beyond this distance, metres.
  constexpr double kFarthestMedian = 400.0;
  if (median_range_ < kFarthestMedian) return;
  point_scale_ = 0.001;
  for (auto& [index, scan] : scans_) {
    for (Eigen::Vector3f& point : scan.points) point *= static_cast<float>(point_scale_);
  }
}

const std::vector<Surfel>& Samples::surfels(std::size_t scan) const {
  const auto found = surfels_.find(scan);
  if (found != surfels_.end()) return found->second;
  const auto read = scans_.find(scan);
  std::vector<Eigen::Vector3f> points;
  if (read != scans_.end()) {
    points = read->second.points;
  } else {
    points = sequence_.scans->load(scan).points;
    for (Eigen::Vector3f& point : points) point *= static_cast<float>(point_scale_);
  }
  return surfels_.emplace(scan, find_surfels(without_near(std::move(points)))).first->second;
}

std::string Samples::scan_name(std::size_t scan) const {
  if (!files_.empty()) return files_[scan].path.filename().string();
  return "scan " + std::to_string(scan);
}

std::string Samples::frame_name(std::size_t scan) const {
  return files_.empty() ? std::to_string(scan) : files_[scan].name;
}

std::string Samples::all_frames() const {
  return "frames " + frame_name(0) + " to " + frame_name(size() - 1);
}

std::string Samples::pose_source() const {
  return sequence_.poses_file.empty() ? "poses" : sequence_.poses_file;
}

double Samples::median_step() const {
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    steps.push_back((poses_[i].translation() - poses_[i - 1].translation()).norm());
  }
  return steps.empty() ? 0.0 : median(std::move(steps));
}

std::vector<Scan> Samples::some_scans(std::size_t most) const {
  std::vector<std::size_t> all;
  for (const auto& [index, scan] : scans_) all.push_back(index);
  std::vector<Scan> chosen;
  for (const std::size_t k : evenly_spread(all.size(), most)) chosen.push_back(scans_.at(all[k]));
  return chosen;
}

const SensorModel& Samples::estimated_sensor() const {
  if (estimated_sensor_) return *estimated_sensor_;
  estimated_sensor_ = estimate_sensor_model(some_scans(5));
  return *estimated_sensor_;
}

}  // namespace raymoval::inspection
