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

/// Two scans that see much of the same.
struct ScanPair {
  std::size_t from = 0, to = 0;  ///< `from` < `to`, positions in the sequence.
};

/// How the poses, or the frame of the points, would have to change for the scans to agree.
struct PoseVerdict {
  std::string check;        ///< Name of the check that reports it; empty if nothing is wrong.
  std::string what;         ///< What the numbers say.
  std::string remedy = {};  ///< With numbers; empty: what the check says in general.
};

/// What the checks look at: the poses and files of the whole sequence, and about thirty scans,
/// evenly spread, with their points. The data is only read.
class Samples {
 public:
  /// @param threads for what reads more scans
  /// @throws DataError if a scan cannot be read; Cancelled
  Samples(const Sequence& sequence, int threads, const std::atomic<bool>* cancel);

  [[nodiscard]] const Sequence& sequence() const { return sequence_; }
  [[nodiscard]] int threads() const { return threads_; }
  [[nodiscard]] const std::atomic<bool>* cancel() const { return cancel_; }
  [[nodiscard]] std::size_t size() const { return poses_.size(); }
  [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }
  /// Files of all scans; empty for a sequence that is not read from scan files.
  [[nodiscard]] const std::vector<FrameEntry>& files() const { return files_; }
  /// Scans that were read, by position. Points are metres (see `point_scale`).
  [[nodiscard]] const std::map<std::size_t, Scan>& scans() const { return scans_; }
  /// Some of them, evenly spread.
  [[nodiscard]] std::vector<Scan> some_scans(std::size_t most) const;
  [[nodiscard]] const std::vector<ScanPair>& pairs() const { return pairs_; }
  /// What the points were multiplied with to be metres: 1, or 0.001 where half of them lie farther
  /// away than metres can be.
  [[nodiscard]] double point_scale() const { return point_scale_; }
  /// Half of the points lie farther from the middle of their scan, in the unit as stored.
  [[nodiscard]] double median_range() const { return median_range_; }
  /// Of any scan; one that is not among `scans` is read for it. @throws DataError as when reading
  [[nodiscard]] const std::vector<Surfel>& surfels(std::size_t scan) const;
  /// The sensor as five of the scans show it, whatever it is called; estimated when first asked
  /// for.
  [[nodiscard]] const SensorModel& seen_sensor() const;
  [[nodiscard]] const Layout& layout() const { return layout_; }
  /// Whether each scan file holds its pose.
  [[nodiscard]] bool has_viewpoints() const { return layout_.pose_place == PosePlace::kScanFile; }
  /// Whether these poses were applied to the stored points.
  [[nodiscard]] bool points_in_world() const {
    return has_viewpoints() && sequence_.records->point_frame() == PointFrame::kWorld;
  }

  /// "000012.bin" or "scan 12".
  [[nodiscard]] std::string scan_name(std::size_t scan) const;
  /// "000012", or the position.
  [[nodiscard]] std::string frame_name(std::size_t scan) const;
  [[nodiscard]] std::string all_frames() const;
  [[nodiscard]] std::string pose_source() const;

  /// The first check that needs it finds it.
  std::optional<PoseVerdict> pose_verdict;
  /// The first check that needs it measures it.
  std::optional<registration::PoseFit> pose_fit;
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
  mutable std::optional<SensorModel> seen_sensor_;
};

}  // namespace raymoval::inspection
