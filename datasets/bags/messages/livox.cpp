// SPDX-License-Identifier: MIT
#include "datasets/bags/messages/livox.h"

#include <algorithm>

#include "datasets/bags/messages/point_cloud.h"

namespace raymoval {
namespace {

/// Bytes of a CustomPoint: a time, three coordinates, and three bytes.
constexpr std::size_t kPointBytes = 19;
/// CDR begins each point at a multiple of four bytes.
constexpr std::size_t kCdrPointStep = 20;

}  // namespace

RecordLayout livox_layout() {
  RecordLayout layout;
  layout.add("offset_time", 'U', 4);
  for (const char* axis : {"x", "y", "z"}) layout.add(axis, 'F', 4);
  for (const char* name : {"reflectivity", "tag", "line"}) layout.add(name, 'U', 1);
  return layout;
}

bool is_livox(const std::string& type) {
  return type == "livox_ros_driver/CustomMsg" || type == "livox_ros_driver2/CustomMsg";
}

PointsMessage parse_livox(MessageReader& reader) {
  PointsMessage cloud;
  cloud.header = read_message_header(reader);
  reader.number<std::uint64_t>("timebase");
  reader.number<std::uint32_t>("point_num");
  reader.skip(4, "lidar_id and rsvd");
  // How many points there are is the length of the sequence; `point_num` only repeats it.
  const std::uint32_t count = reader.count("points", kPointBytes);
  cloud.layout = livox_layout();
  cloud.swapped = reader.big_endian();
  cloud.height = 1;
  cloud.width = count;
  cloud.point_step = reader.is_cdr() ? kCdrPointStep : kPointBytes;
  cloud.row_step = cloud.point_step * count;
  cloud.points_begin = reader.position();
  // The last point is not filled up.
  if (count > 0) reader.skip(cloud.point_step * (count - 1U) + kPointBytes, "points");
  return cloud;
}

}  // namespace raymoval
