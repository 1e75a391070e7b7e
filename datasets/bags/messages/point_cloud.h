// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "datasets/bags/messages/message_reader.h"
#include "datasets/clouds/format/cloud_format.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// Whether `type` is a message with points: sensor_msgs/PointCloud2, or CustomMsg of a Livox
/// driver.
bool has_points(const std::string& type);

/// Largest number of points of a message. Scans have fewer; a message with more is refused.
inline constexpr std::uint64_t kMostScanPoints = std::uint64_t{1} << 24;

/// The beginning of a message with points.
struct PointsHead {
  MessageHeader header;
  std::uint64_t size = 0;  ///< Number of points, including points without a return.
  RecordLayout layout;     ///< Of the result of `read_points`.
};
/// @param bytes the message, or its first `kHeaderBytes` bytes
/// @throws DataError naming the field that is truncated or does not fit its point, or for too many
///   points; UsageError if `has_points` is false
PointsHead read_points_head(std::string_view bytes, const std::string& type,
                            MessageEncoding encoding, const std::string& where);

/// The points of a message with all their fields.
/// - PointCloud2: the layout of the message with all offsets. A count of 0 is read as 1, because
///   some drivers write it. Big-endian numbers are converted to little-endian. Padding at the end
///   of rows is left out.
/// - CustomMsg: offset_time (nanoseconds from the stamp on), x, y, z, reflectivity, tag and line.
/// @param where begins messages: "drive.bag: /points, message 12"
/// @throws DataError as `read_points_head`, and naming the field that has an unknown type;
///   UsageError if `has_points` is false
PointRecords read_points(std::string_view bytes, const std::string& type, MessageEncoding encoding,
                         const std::string& where);

/// Reads positions and intensities only. If no conversion is needed, the other fields are not
/// copied.
/// @param origin metres, as in `cloud_of`
/// @throws as `read_points`; DataError if x, y or z is missing
Cloud read_point_positions(std::string_view bytes, const std::string& type,
                           MessageEncoding encoding, const Eigen::Vector3d& origin,
                           const std::string& where);

}  // namespace raymoval
