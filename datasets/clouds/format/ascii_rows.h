// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string_view>

#include "datasets/clouds/format/cloud_bytes.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// The positions and strengths of points that stand in a line each. Other fields are not looked at.
/// @param body what follows the header
/// @param origin as `read_cloud`
/// @throws DataError with line and column for what is no number; with the line for a wrong count of
///   values or of lines
Cloud ascii_cloud(const CloudHeader& header, std::string_view body,
                  const std::filesystem::path& path, const Eigen::Vector3d& origin);

/// All fields of such points, each value as a number of its type: whole types exactly to 64 bits,
/// reals rounded to nearest. Padding is read where it is a number.
/// @throws DataError as `ascii_cloud`, also for a number that the field's type does not have
PointRecords ascii_records(const CloudHeader& header, std::string_view body,
                           const std::filesystem::path& path);

}  // namespace raymoval
