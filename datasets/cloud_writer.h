// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/file_writer.h"

namespace raymoval {

/// Writes a cloud piece by piece as .pcd (binary), .ply (binary, little-endian) or .bin (float32
/// x y z reflectance); only the piece at hand is in memory. The file appears at `commit`, whole.
///
/// The head of .pcd and .ply names the count of points, which is known at the end only: a comment
/// in it gives room for the digits, so that it always has the same length.
class CloudWriter {
 public:
  /// Opens the file. @throws UsageError for another extension, DataError if it cannot be written
  explicit CloudWriter(const std::filesystem::path& path);

  /// To be called before `add`.
  /// @param with_intensity whether .pcd and .ply have a field for it; .bin always has
  void start(bool with_intensity);
  /// @param points metres
  /// @param intensity as long as `points`, or empty: then it counts as 0
  /// @throws DataError when the disk is full, or beyond 4,294,967,295 points
  void add(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& intensity);
  /// Ends the file and puts it on the disk, still without its name.
  void finish();
  /// Gives it its name, after `finish`.
  void commit() { file_.commit(); }

 private:
  [[nodiscard]] std::string header() const;

  FileWriter file_;
  std::string extension_;
  bool with_intensity_ = false;
  std::uint64_t points_ = 0;
};

}  // namespace raymoval
