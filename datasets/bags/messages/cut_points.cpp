// SPDX-License-Identifier: MIT
#include "datasets/bags/messages/cut_points.h"

#include <algorithm>

#include "core/error.h"
#include "datasets/bags/messages/livox.h"
#include "datasets/bags/messages/point_cloud.h"

namespace raymoval {
namespace {

/// Where a message says how many points it has, and where they end.
struct Places {
  std::size_t height = 0, width = 0, row_step = 0;  ///< Of a PointCloud2.
  std::size_t point_num = 0;                        ///< Of a CustomMsg.
  std::size_t count = 0;                            ///< The length of the sequence.
  std::size_t end = 0;                              ///< Behind the sequence.
};

Places places_in_cloud(MessageReader reader) {
  Places places;
  (void)read_message_header(reader);
  places.height = reader.aligned_position(4);
  places.width = places.height + 4;
  reader.number<std::uint32_t>("height");
  reader.number<std::uint32_t>("width");
  const std::uint32_t fields = reader.number<std::uint32_t>("fields");
  for (std::uint32_t i = 0; i < fields; ++i) {
    reader.text("fields.name");
    reader.number<std::uint32_t>("fields.offset");
    reader.number<std::uint8_t>("fields.datatype");
    reader.number<std::uint32_t>("fields.count");
  }
  reader.number<std::uint8_t>("is_bigendian");
  reader.number<std::uint32_t>("point_step");
  places.row_step = reader.aligned_position(4);
  reader.number<std::uint32_t>("row_step");
  places.count = reader.aligned_position(4);
  reader.skip(reader.count("data", 1), "data");
  places.end = reader.position();
  return places;
}

Places places_in_livox(MessageReader reader, std::size_t points_end) {
  Places places;
  (void)read_message_header(reader);
  reader.number<std::uint64_t>("timebase");
  places.point_num = reader.aligned_position(4);
  reader.number<std::uint32_t>("point_num");
  reader.skip(4, "lidar_id and rsvd");
  places.count = reader.aligned_position(4);
  places.end = points_end;
  return places;
}

void check_keep(const PointsMessage& cloud, const std::vector<std::uint8_t>& keep,
                const std::string& where) {
  if (keep.size() == cloud.size()) return;
  throw InternalError(where + ": a choice of " + std::to_string(keep.size()) + " among " +
                      std::to_string(cloud.size()) + " points");
}

}  // namespace

std::string without_points(std::string_view message, const std::string& type,
                           MessageEncoding encoding, const std::vector<std::uint8_t>& keep,
                           const std::string& where) {
  if (!has_points(type)) throw UsageError(where + ": is of type " + type + ", without points.");
  const bool livox = is_livox(type);
  const MessageReader begin(message, encoding, where);
  MessageReader reader = begin;
  const PointsMessage cloud = livox ? parse_livox(reader) : parse_point_cloud(reader);
  check_keep(cloud, keep, where);
  const auto is_kept = [](std::uint8_t kept) { return kept != 0; };
  if (std::all_of(keep.begin(), keep.end(), is_kept)) return std::string(message);
  const Places places = livox ? places_in_livox(begin, reader.position()) : places_in_cloud(begin);

  const auto left = static_cast<std::uint32_t>(std::count_if(keep.begin(), keep.end(), is_kept));
  std::string result(message.substr(0, cloud.points_begin));
  const auto put = [&](std::size_t place, std::uint64_t value) {
    result.replace(place, 4, written_u32(begin, static_cast<std::uint32_t>(value)));
  };
  if (livox) {
    put(places.point_num, left);
    put(places.count, left);
  } else {
    put(places.height, 1);
    put(places.width, left);
    put(places.row_step, left * cloud.point_step);
    put(places.count, left * cloud.point_step);
  }
  const std::size_t point_bytes = cloud.layout.row_bytes;
  const std::size_t padding = static_cast<std::size_t>(cloud.point_step) - point_bytes;
  for (std::uint64_t point = 0; point < cloud.size(); ++point) {
    if (keep[point] == 0) continue;
    if (result.size() > cloud.points_begin) result.append(padding, '\0');
    result.append(message.substr(cloud.place(point), point_bytes));
  }
  result.append(message.substr(places.end));
  return result;
}

}  // namespace raymoval
