// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "benchmark/report/thinned_points.h"
#include "benchmark/run/kept_run.h"
#include "core/progress.h"

namespace raymoval {

/// Edge of the voxels that a page names and thins by, metres: that of the `erasor` protocol.
inline constexpr double kPageVoxel = 0.2;

/// A cell whose points can be shown.
struct SceneCell {
  std::string name;  ///< Of the method in the suite.
  bool control = false;
  MaskStore masks;
  std::filesystem::path removals;      ///< Folder of the reasons.
  std::vector<std::string> sentences;  ///< Of its reasons; empty if it gave none.
};

/// Points of a kept cell by what became of them.
struct VerdictCounts {
  std::uint64_t kept_static = 0, false_positive = 0, true_positive = 0, false_negative = 0;
};

/// A semantic class that occurs.
struct SceneLabel {
  std::uint16_t id = 0;
  std::string name;
  LabelClass kind = LabelClass::kStatic;
};

/// What the 3-D view shows of a sequence.
struct Scene {
  std::string sequence;
  std::vector<SceneCell> cells;
  std::vector<VerdictCounts> counts;  ///< Of each cell, over all points within the range limits.
  std::vector<std::string> scans;     ///< Names.
  /// Turns the world so that up is z: that is how points and trajectory stand here.
  Pose T_upright_world = Pose::Identity();
  std::vector<Eigen::Vector3d> trajectory;  ///< Sensor positions, metres.
  std::vector<SceneLabel> labels;           ///< By id.
  std::uint64_t points_in_range = 0;
  int error_cell = 0, other_cell = 0;  ///< What points were thinned by, in steps; 0: not at all.
  std::vector<ShownPoint> points;      ///< Along a Morton curve.
  /// Of each cell, a byte for each point: bit 0 removed, above it 1 + the reason's code, or 0.
  std::vector<std::vector<std::uint8_t>> verdicts;
};

/// Reads scans, labels and removals. Points that a method judged wrongly come first, the others are
/// one per `kPageVoxel` (moving ones one per scan too), each with larger cells if `limit` asks for
/// it. Controls, which judge wrongly on purpose, do not make a point wrongly judged.
/// @throws DataError for damaged reasons
Scene build_scene(const Sequence& sequence, std::vector<SceneCell> cells, std::size_t limit,
                  Progress* progress);

/// A scene as a page has it.
struct PackedScene {
  /// Names, numbers, trajectory, labels, and how to read the rest.
  std::vector<std::pair<std::string, std::string>> streams;  ///< Id and base64 of deflated bytes.
};

/// @param number of the scene in the page, for the ids of its streams
/// @param head receives what a reader needs besides the streams
PackedScene pack_scene(const Scene& scene, std::size_t number, nlohmann::ordered_json& head);

}  // namespace raymoval
