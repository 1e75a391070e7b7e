// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/clouds/file_source.h"
#include "datasets/geometry/surfels.h"
#include "datasets/inspection/evidence/finding.h"
#include "datasets/layouts.h"
#include "datasets/registration/pose_fit.h"

namespace raymoval::inspection {

/// Two scans with much overlap.
struct ScanPair {
  std::size_t from = 0, to = 0;  ///< `from` < `to`, positions in the sequence.
};

/// The positions of the sensors of merged clouds whose points name their sensor.
struct SeenSensors {
  bool are_merged = false;
  bool are_known = true;  ///< The position of each sensor is known.
  std::vector<Finding> findings = {};
};

/// The change of the poses, or of the frame of the points, that makes the scans agree.
struct PoseVerdict {
  std::string check;        ///< Name of the check that reports it; empty without a defect.
  std::string what;         ///< The defect, with numbers.
  std::string remedy = {};  ///< With numbers; empty: the remedy of the check.
};

/// The input of checks: the poses and files of the whole sequence, and the points of about thirty
/// scans, evenly spread. The data is only read.
class Samples {
 public:
  /// @param threads for checks that read more scans
  /// @throws DataError if a scan cannot be read; Cancelled
  Samples(const Sequence& sequence, int threads, const std::atomic<bool>* cancel);

  [[nodiscard]] const Sequence& sequence() const { return sequence_; }
  [[nodiscard]] int threads() const { return threads_; }
  [[nodiscard]] const std::atomic<bool>* cancel() const { return cancel_; }
  [[nodiscard]] std::size_t size() const { return poses_.size(); }
  [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }
  /// Files of all scans; empty if the sequence has no scan files.
  [[nodiscard]] const std::vector<FrameEntry>& files() const { return files_; }
  /// Scans that were read, by position. Points are in metres (see `point_scale`).
  [[nodiscard]] const std::map<std::size_t, Scan>& scans() const { return scans_; }
  /// At most `most` of these scans, evenly spread.
  [[nodiscard]] std::vector<Scan> some_scans(std::size_t most) const;
  [[nodiscard]] const std::vector<ScanPair>& pairs() const { return pairs_; }
  /// Distance from a scan to the next, metres: the median over the whole sequence.
  [[nodiscard]] double median_step() const;
  /// Factor from stored points to metres: 1, or 0.001 if half of the points are implausibly far for
  /// metres.
  [[nodiscard]] double point_scale() const { return point_scale_; }
  /// Median distance of points from the middle of their scan, in the stored unit.
  [[nodiscard]] double median_range() const { return median_range_; }
  /// The surfels of any scan; reads the scan if it is not in `scans`. @throws DataError as reading
  [[nodiscard]] const std::vector<Surfel>& surfels(std::size_t scan) const;
  /// The sensor model estimated from five of the scans, independent of its name. The first call
  /// estimates it.
  [[nodiscard]] const SensorModel& estimated_sensor() const;
  [[nodiscard]] const Layout& layout() const { return layout_; }
  /// Whether each scan file has its pose.
  [[nodiscard]] bool has_viewpoints() const { return layout_.pose_place == PosePlace::kScanFile; }
  /// Whether the stored points are in the world frame.
  [[nodiscard]] bool points_in_world() const {
    return has_viewpoints() && sequence_.records->point_frame() == PointFrame::kWorld;
  }

  /// "000012.bin" or "scan 12".
  [[nodiscard]] std::string scan_name(std::size_t scan) const;
  /// "000012", or the position.
  [[nodiscard]] std::string frame_name(std::size_t scan) const;
  [[nodiscard]] std::string all_frames() const;
  [[nodiscard]] std::string pose_source() const;

  /// Set by the first check that needs it: whether the pose file has quaternions.
  std::optional<bool> quaternions;
  /// Set by the first check that needs it.
  std::optional<PoseVerdict> pose_verdict;
  /// Set by the first check that needs it.
  std::optional<registration::PoseFit> pose_fit;
  /// Set by the first check that needs it.
  std::optional<SeenSensors> seen_sensors;
  std::vector<std::pair<std::string, double>> measures;

 private:
  void choose_pairs();
  void read_scans();
  void measure_range();
  void settle_point_unit();

  const Sequence& sequence_;
  int threads_;
  const std::atomic<bool>* cancel_;
  const Layout& layout_;
  std::vector<FrameEntry> files_;
  std::vector<Pose> poses_;
  std::vector<ScanPair> pairs_;
  std::map<std::size_t, Scan> scans_;
  double point_scale_ = 1.0;
  double median_range_ = 0.0;
  mutable std::map<std::size_t, std::vector<Surfel>> surfels_;
  mutable std::optional<SensorModel> estimated_sensor_;
};

}  // namespace raymoval::inspection
