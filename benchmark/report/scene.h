// SPDX-License-Identifier: MIT
#pragma once

#include <tsl/robin_set.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "benchmark/result/removals/edits.h"
#include "benchmark/run/folder/kept_run.h"
#include "core/progress.h"
#include "core/scan/scan.h"
#include "core/scan/voxel_key.h"

namespace raymoval {

/// A point that may be shown.
struct ShownPoint {
  MapSteps step;  ///< Position in steps, rounded down.
  std::uint32_t scan = 0;
  std::uint16_t label = 0;  ///< Semantic id.
};

/// Keeps points up to a limit. If more come, it divides space into cells and keeps the first point
/// of each cell; the cells grow until the limit holds. The result depends only on the points and
/// their order.
class ReportPoints {
 public:
  /// @param verdicts the number of bytes for each point
  /// @param cell the first size of a cell in steps. If 0, all points are kept while there is room
  ReportPoints(std::size_t limit, std::size_t verdicts, int cell)
      : limit_(limit), verdicts_(verdicts), cell_(cell) {}

  /// @param group each group is thinned separately
  void add(const ShownPoint& point, std::uint64_t group, std::span<const std::uint8_t> verdict);
  /// Thins to `limit` or fewer.
  void reduce(std::size_t limit);
  /// Makes the edge of the cells a multiple of `steps`.
  void align(int steps);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] int cell() const { return cell_; }
  [[nodiscard]] const std::vector<ShownPoint>& points() const { return points_; }
  /// The bytes of point `i`.
  [[nodiscard]] std::span<const std::uint8_t> verdict(std::size_t i) const {
    return {bytes_.data() + i * verdicts_, verdicts_};
  }

 private:
  [[nodiscard]] std::uint64_t key(const ShownPoint& point, std::uint64_t group) const;
  void grow_cells();
  void thin();

  std::size_t limit_, verdicts_;
  int cell_;
  std::vector<ShownPoint> points_;
  std::vector<std::uint64_t> groups_;
  std::vector<std::uint8_t> bytes_;
  tsl::robin_set<std::uint64_t, VoxelKeyHash> taken_;
};

/// A cell whose points can be shown.
struct SceneCell {
  std::string name;  ///< The method's name in the suite.
  bool control = false;
  MaskStore masks;
  std::filesystem::path removals;      ///< The folder that holds the reasons.
  std::vector<std::string> sentences;  ///< The meaning of its reasons; empty if it gave none.
};

/// How many points of a cell had each outcome.
struct VerdictCounts {
  std::uint64_t kept_static = 0, false_positive = 0, true_positive = 0, false_negative = 0;
};

/// A semantic class that occurs in the sequence.
struct SceneLabel {
  std::uint16_t id = 0;
  std::string name;
  LabelClass kind = LabelClass::kStatic;
};

/// The content of the 3-D view for a sequence.
struct Scene {
  std::string sequence;
  /// Whether the sequence has no labels: points are kept or removed, but not right or wrong.
  bool is_unlabelled = false;
  std::vector<SceneCell> cells;
  std::vector<VerdictCounts> counts;  ///< One for each cell, over all points in range.
  std::vector<std::string> scans;     ///< The names of the scans.
  /// The rotation that turns up to z. Points and trajectory here are turned by it.
  Pose T_upright_world = Pose::Identity();
  std::vector<Eigen::Vector3d> trajectory;  ///< Sensor positions, metres.
  std::vector<SceneLabel> labels;           ///< By id.
  std::uint64_t points_in_range = 0;
  /// Cells by which points were thinned, in steps; 0: not thinned. Without labels, these are the
  /// cells of removed and of kept points.
  int error_cell = 0, other_cell = 0;
  std::vector<ShownPoint> points;  ///< In the order of a Morton curve.
  /// Coordinates in a page are rounded down to units of at least 2^shift steps, here 2.5 cm.
  int shift = 1;
  /// For each cell a byte for each point. Bit 0 is set if the point was removed; the bits above it
  /// hold the reason's code plus 1, or 0 if there is no reason.
  /// Of a cleaned map, the second byte is the confidence in steps (`kConfidenceSteps`).
  std::vector<std::vector<std::uint8_t>> verdicts;
  Edits
      review;  ///< Of a cleaned map: the method's answer, which the page exports with corrections.
  /// Of a cleaned map: the number of points of each confidence; empty without confidence.
  std::vector<std::uint64_t> confidences;
};

/// Reads scans, labels and removals, and chooses at most `limit` points. Points that a method
/// classified wrongly come first. Of the other points, one is shown in each voxel of `kPageVoxel`;
/// of moving points, one in each voxel and scan. Both are thinned by larger cells if `limit`
/// requires it. Controls are wrong on purpose, so their errors do not count.
/// @throws DataError if reasons are damaged
Scene build_scene(const Sequence& sequence, std::vector<SceneCell> cells, std::size_t limit,
                  Progress* progress);

/// Chooses the points of a cleaned map for a page, scan by scan: kept and removed points, without
/// labels. At most `limit` points are held. One point is shown in each cell of `kPageVoxel`, or of
/// larger cells if `limit` requires it; kept points with `kUncertainSteps` or more are thinned
/// separately. Up to 40 % of the points are removed points, one in each cell and scan.
class MapSceneBuilder {
 public:
  static constexpr int kUncertainSteps = 5;

  /// @param method the name for removed points in the page
  /// @param T_upright_world the rotation that turns up to z
  MapSceneBuilder(const std::string& sequence, const std::string& method,
                  const Pose& T_upright_world, std::size_t limit);

  /// Must be called for each scan, also without points.
  /// @param mask 1 = removed, 0 = kept, other values are not shown
  /// @param confidence of each point in steps (`kConfidenceSteps`); empty if there is none
  void add(const Scan& scan, const Mask& mask, std::string_view confidence = {});
  Scene finish();

 private:
  std::size_t limit_;
  ReportPoints removed_, kept_;
  Scene scene_;
};

/// The form of a scene in a page.
struct PackedScene {
  /// JSON for a <script> element: names, numbers, trajectory, labels, and how to read the streams.
  std::string head;
  std::vector<std::pair<std::string, std::string>> streams;  ///< Id and base64 of deflated bytes.
};

/// The origin and the resolution of the points' coordinates in a page.
struct PageFrame {
  MapSteps origin{};  ///< Voxels.
  int shift = 0;      ///< 2^shift steps are one unit of a coordinate.
};
/// @param shift at least, see `Scene`
PageFrame page_frame(const std::vector<ShownPoint>& points, int shift);

/// @param number of the scene in the page, for the ids of its streams
PackedScene pack_scene(const Scene& scene, std::size_t number);

}  // namespace raymoval
