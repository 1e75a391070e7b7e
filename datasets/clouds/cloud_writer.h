// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/clouds/record_file.h"

namespace raymoval {

/// How a cloud file holds x, y and z.
enum class Coordinates { kFloat, kDouble };

/// Refuses a format that cannot hold `coordinates`: .bin has float32 only.
/// @throws UsageError naming the file and the remedy
void check_coordinates(const std::filesystem::path& path, Coordinates coordinates);

/// Writes positions and strengths of points piece by piece, in any format that
/// `PointRecordWriter` writes; only the piece at hand is in memory. The file appears at `commit`,
/// whole.
class CloudWriter {
 public:
  /// Opens the file. @throws UsageError for another extension, DataError if it cannot be written
  explicit CloudWriter(const std::filesystem::path& path) : file_(path) {}

  /// To be called before `add`.
  /// @param with_intensity whether there is a field for it; .bin always has one
  /// @param coordinates float32, or float64 for points far from the origin
  /// @throws UsageError for float64 in a .bin file, which has none
  void start(bool with_intensity, Coordinates coordinates = Coordinates::kFloat);
  /// @param points metres
  /// @param intensity as long as `points`, or empty: then it counts as 0
  /// @throws DataError when the disk is full, or beyond 4,294,967,295 points
  void add(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& intensity);
  /// The same for points in double precision.
  void add_exact(const std::vector<Eigen::Vector3d>& points, const std::vector<float>& intensity);
  /// Ends the file and puts it on the disk, still without its name.
  void finish() { file_.finish(); }
  /// Gives it its name, after `finish`.
  void commit() { file_.commit(); }
  /// The same together with others.
  void commit_with(Replacements& together) { file_.commit_with(together); }

 private:
  template <class Point>
  void add_points(const std::vector<Point>& points, const std::vector<float>& intensity);

  PointRecordWriter file_;
  PointRecords rows_;  ///< The piece at hand.
  bool with_intensity_ = false;
  Coordinates coordinates_ = Coordinates::kFloat;
};

/// Writes a whole file, atomically.
/// @param intensity as long as `points`, or empty: then there is no such field, and .bin holds
/// zeros
void write_cloud(const std::filesystem::path& path, const std::vector<Eigen::Vector3f>& points,
                 const std::vector<float>& intensity = {});

}  // namespace raymoval
