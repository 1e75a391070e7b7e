// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/clean/outputs/clean_output.h"
#include "benchmark/picture/maps/top_down.h"
#include "benchmark/report/scene.h"
#include "core/files/file_writer.h"

namespace raymoval {

/// The texts of pictures and pages of a cleaned map.
struct ViewTexts {
  std::string sequence, method;
  bool with_path = false;  ///< Whether the picture shows the path of the sensor.
};

/// The cleaned map from above as a PNG: kept points are grey, removed points coloured. Memory is
/// bounded by the picture.
class MapPictureFile : public CleanOutput {
 public:
  /// @param window in the upright world, metres
  MapPictureFile(const std::filesystem::path& path, ViewTexts texts, const Pose& T_upright_world,
                 const WorldWindow& window);
  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { file_.commit_with(together); }

 private:
  void draw_path(Canvas& canvas, int x, int y) const;

  FileWriter file_;
  ViewTexts texts_;
  Pose T_upright_world_;
  WorldWindow window_;
  double resolution_;  ///< Metres per pixel.
  TopDownRaster raster_;
  std::vector<Eigen::Vector3d> path_;  ///< Of the sensor, in the upright world.
};

/// The cleaned map as a page for review. Memory is bounded by the points that it shows.
class MapPageFile : public CleanOutput {
 public:
  /// Points that a page shows at most.
  static constexpr std::size_t kMostPoints = 1'000'000;

  MapPageFile(const std::filesystem::path& path, ViewTexts texts, const Pose& T_upright_world);
  void add(const CleanedScan& scan) override;
  void finish() override;
  void commit_with(Replacements& together) override { file_.commit_with(together); }

 private:
  FileWriter file_;
  ViewTexts texts_;
  MapSceneBuilder scene_;
};

}  // namespace raymoval
