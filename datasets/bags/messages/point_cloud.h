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

/// Largest number of points of a message. A scan of a LiDAR has fewer; a message with more is
/// refused.
inline constexpr std::uint64_t kMostScanPoints = std::uint64_t{1} << 24;

/// What a message with points begins with.
struct PointsHead {
  MessageHeader header;
  std::uint64_t size = 0;  ///< Points, those without a return counted.
  RecordLayout layout;     ///< Of what `read_points` gives.
};
/// @param bytes the message, or its first `kHeaderBytes` bytes
/// @throws DataError naming the field that is cut or does not fit its point, or for too many
///   points; UsageError if `has_points` does not hold
PointsHead read_points_head(std::string_view bytes, const std::string& type,
                            MessageEncoding encoding, const std::string& where);

/// The points of a message with all their fields.
/// - PointCloud2: the layout is the message's own with all offsets; a count of 0 stands for 1, as
///   some drivers write it. Big-endian numbers are turned to little-endian. Padding at the end of
///   rows is left out.
/// - CustomMsg: offset_time (nanoseconds from the stamp on), x, y, z, reflectivity, tag and line.
/// @param where begins messages: "drive.bag: /points, message 12"
/// @throws DataError as `read_points_head`, and naming the field that has an unknown type;
///   UsageError if `has_points` does not hold
PointRecords read_points(std::string_view bytes, const std::string& type, MessageEncoding encoding,
                         const std::string& where);

/// Positions and strengths only. Where the message has them as they are, they are taken out of it
/// without a copy of the rest.
/// @param origin metres, as in `cloud_of`
/// @throws as `read_points`; DataError if x, y or z is missing
Cloud read_point_positions(std::string_view bytes, const std::string& type,
                           MessageEncoding encoding, const Eigen::Vector3d& origin,
                           const std::string& where);

}  // namespace raymoval
