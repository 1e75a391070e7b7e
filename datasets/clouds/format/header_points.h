// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/clouds/format/cloud_format.h"
#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {

/// The positions and strengths of the points of a PCD or PLY file. Of text, other fields are not
/// looked at.
/// @param origin as `read_cloud`
/// @throws DataError with line and column for what is no number, with the line for a wrong count of
///   values or of lines; if there are fewer bytes than the header's points take, or a compressed
///   body is damaged
Cloud header_cloud(const CloudHeader& header, const CloudBytes& file,
                   const Eigen::Vector3d& origin);

/// All fields of such points. In text each value is a number of its type: whole types exactly to 64
/// bits, reals rounded to nearest; padding is read where it is a number.
/// @throws DataError as `header_cloud`, also for a number that the field's type does not have
PointRecords header_records(const CloudHeader& header, const CloudBytes& file);

}  // namespace raymoval
