// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/records/point_records.h"

namespace raymoval {

/// Points as a file stores them, non-finite ones included.
struct Cloud {
  std::vector<Eigen::Vector3f> points;
  /// The strength of each return: the field with one of `intensity_names`. As long as `points`, or
  /// empty if the file has no such field with one value a point.
  std::vector<float> intensity;
};

/// What a file does not say of itself.
struct RecordReading {
  /// Fields of a .bin file or the columns of an .npy array, such as "x y z intensity t:f8" (float32
  /// where no type is given), see `parse_point_layout`.
  std::optional<std::string> point_layout = std::nullopt;
};

/// A real intensity that a file also has as a whole number from 0 to 65,535, for viewers.
struct ShownIntensity {
  PointField field;
  std::string exact;  ///< The name of the field of the file that has the value as it is.
};

/// How a file of point records is to be written.
struct RecordWriting {
  /// LAS: the coordinate reference system as WKT, a file with WKT, or "EPSG:32632" (see
  /// `reference_system_text`); no other format holds one.
  std::optional<std::string> crs = std::nullopt;
  /// LAS: what a real intensity is multiplied by for the whole number from 0 to 65535 that viewers
  /// show. The exact value stands beside it.
  double intensity_scale = 1.0;
  /// How PCD and PLY files store numbers: binary and little-endian, unless it says otherwise.
  StoredForm form = {};
};

/// The content of a file of points, unpacked.
struct CloudBytes {
  const std::filesystem::path& path;  ///< For messages.
  std::string_view text;
  const RecordReading& reading;
};

}  // namespace raymoval
