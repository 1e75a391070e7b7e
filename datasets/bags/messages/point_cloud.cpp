// SPDX-License-Identifier: MIT
#include "datasets/bags/messages/point_cloud.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/stored_points.h"

namespace raymoval {
namespace {

struct NumberType {
  char type;
  int size;
};

/// sensor_msgs/PointField's numbers for types, from 1 on.
constexpr std::array kTypes = {NumberType{'I', 1}, NumberType{'U', 1}, NumberType{'I', 2},
                               NumberType{'U', 2}, NumberType{'I', 4}, NumberType{'U', 4},
                               NumberType{'F', 4}, NumberType{'F', 8}};

bool is_point_cloud(const std::string& type) {
  return type == "sensor_msgs/PointCloud2";
}

/// Whether `type` is the message in which Livox's drivers publish points.
bool is_livox(const std::string& type) {
  return type == "livox_ros_driver/CustomMsg" || type == "livox_ros_driver2/CustomMsg";
}

/// The description of the points in a message. Positions are bytes of the message.
struct PointsMessage {
  MessageHeader header;
  RecordLayout layout;   ///< Of a point in the message.
  bool swapped = false;  ///< Whether the numbers of the points are big-endian.
  std::uint32_t width = 0, height = 0;
  std::uint64_t row_step = 0;    ///< Bytes from a row to the next.
  std::uint64_t point_step = 0;  ///< Bytes from a point to the next.
  std::size_t points_begin = 0;  ///< The first point.

  [[nodiscard]] std::uint64_t size() const { return std::uint64_t{width} * height; }
};

PointField read_field(MessageReader& reader) {
  PointField field;
  field.name = reader.text("fields.name");
  field.offset = reader.number<std::uint32_t>("fields.offset");
  const auto type = reader.number<std::uint8_t>("fields.datatype");
  const auto count = std::max(1U, reader.number<std::uint32_t>("fields.count"));
  if (type < 1 || type > kTypes.size()) {
    reader.fail("the field '" + field.name + "' has the unknown type " + std::to_string(type) +
                "; expected 1 (int8) to 8 (float64). Have it published as one of these.");
  }
  field.type = kTypes[type - 1U].type;
  field.size = kTypes[type - 1U].size;
  constexpr std::uint32_t kMostValues = 1U << 24U;
  if (count > kMostValues) {
    reader.fail("the field '" + field.name + "' should have " + grouped_text(count) +
                " values a point; the message looks damaged.");
  }
  field.count = static_cast<int>(count);
  return field;
}

void check_size(std::uint64_t points, const MessageReader& reader) {
  if (points <= kMostScanPoints) return;
  reader.fail("it announces " + grouped_text(points) + " points; a scan has at most " +
              grouped_text(kMostScanPoints) +
              ". The message is damaged or holds a whole map: choose a --topic with scans.");
}

/// Refuses points that share their bytes: a small message could announce very many of them.
void check_overlaps(const PointsMessage& cloud, const MessageReader& reader) {
  constexpr std::uint64_t kMostUses = 4;  // Drivers name a colour twice, as rgb and rgba.
  std::uint64_t bytes = 0;
  for (const PointField& field : cloud.layout.fields) bytes += field.bytes();
  const auto is_after = [&](const char* one, const char* other) {
    const PointField *a = cloud.layout.find({one}), *b = cloud.layout.find({other});
    return a == nullptr || b == nullptr || a->offset + a->bytes() <= b->offset;
  };
  for (const auto& [one, other] : {std::pair("x", "y"), std::pair("y", "z"), std::pair("x", "z")}) {
    if (is_after(one, other) || is_after(other, one)) continue;
    reader.fail(std::string("the fields '") + one + "' and '" + other +
                "' share bytes of a point; expected bytes of their own. Correct the offsets where "
                "the message is published.");
  }
  if (bytes <= kMostUses * cloud.point_step) return;
  reader.fail("the fields take " + grouped_text(bytes) + " bytes of a point, but point_step is " +
              grouped_text(cloud.point_step) + "; expected at most four times as much. Correct " +
              "the offsets where the message is published.");
}

void check_fields(const PointsMessage& cloud, const MessageReader& reader) {
  for (const PointField& field : cloud.layout.fields) {
    if (field.offset + field.bytes() <= cloud.point_step) continue;
    reader.fail("the field '" + field.name + "' ends at byte " +
                grouped_text(field.offset + field.bytes()) + " of a point, but point_step is " +
                grouped_text(cloud.point_step) + "; the publisher's layout contradicts itself.");
  }
  check_overlaps(cloud, reader);
}

/// Corrects the layout by the size of the data. `row_step` matters only with several rows; with one
/// row, some drivers write 0 or a wrong value.
void check_data(PointsMessage& cloud, std::uint64_t data_bytes, const MessageReader& reader) {
  const std::uint64_t row = cloud.width * cloud.point_step;
  if (cloud.height <= 1 || cloud.row_step < row) cloud.row_step = row;
  // Some publishers put the bytes of all rows there.
  const bool of_all =
      cloud.height > 1 && cloud.row_step == data_bytes && row <= data_bytes / cloud.height;
  if (of_all) cloud.row_step = row;
  if (cloud.size() == 0) return;
  if (cloud.point_step == 0) reader.fail("point_step is 0, but there are points.");
  // One row that does not fit is enough, and the product of all could be beyond 64 bits.
  const std::uint64_t wanted = row > data_bytes ? row : cloud.row_step * (cloud.height - 1U) + row;
  if (wanted <= data_bytes) return;
  reader.fail(grouped_text(cloud.height) + " x " + grouped_text(cloud.width) + " points of " +
              grouped_text(cloud.point_step) + " bytes take " + grouped_text(wanted) +
              " bytes, but data has " + grouped_text(data_bytes) +
              "; the message is truncated or contradicts itself.");
}

/// The fields of a PointCloud2 before its data.
PointsMessage parse_cloud_head(MessageReader& reader) {
  // A field has a name with its length, an offset, a type and a count.
  constexpr std::size_t kLeastField = 13;
  PointsMessage cloud;
  cloud.header = read_message_header(reader);
  cloud.height = reader.number<std::uint32_t>("height");
  cloud.width = reader.number<std::uint32_t>("width");
  const std::uint32_t fields = reader.count("fields", kLeastField);
  for (std::uint32_t i = 0; i < fields; ++i) cloud.layout.fields.push_back(read_field(reader));
  cloud.swapped = reader.number<std::uint8_t>("is_bigendian") != 0;
  cloud.point_step = cloud.layout.row_bytes = reader.number<std::uint32_t>("point_step");
  cloud.row_step = reader.number<std::uint32_t>("row_step");
  check_size(cloud.size(), reader);
  if (cloud.size() > 0) check_fields(cloud, reader);
  return cloud;
}

PointsMessage parse_point_cloud(MessageReader& reader) {
  PointsMessage cloud = parse_cloud_head(reader);
  const std::uint32_t data_bytes = reader.count("data", 1);
  cloud.points_begin = reader.position();
  reader.skip(data_bytes, "data");
  reader.number<std::uint8_t>("is_dense");
  check_data(cloud, data_bytes, reader);
  return cloud;
}

RecordLayout livox_layout() {
  RecordLayout layout;
  layout.add("offset_time", 'U', 4);
  for (const char* axis : {"x", "y", "z"}) layout.add(axis, 'F', 4);
  for (const char* name : {"reflectivity", "tag", "line"}) layout.add(name, 'U', 1);
  return layout;
}

PointsMessage parse_livox(MessageReader& reader) {
  // A CustomPoint has 19 bytes. CDR begins each at a multiple of four bytes.
  constexpr std::size_t kPointBytes = 19, kCdrPointStep = 20;
  PointsMessage cloud;
  cloud.header = read_message_header(reader);
  reader.number<std::uint64_t>("timebase");
  reader.number<std::uint32_t>("point_num");
  reader.skip(4, "lidar_id and rsvd");
  // The length of the sequence is the number of points; `point_num` only repeats it.
  const std::uint32_t count = reader.count("points", kPointBytes);
  check_size(count, reader);
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

PointsMessage parse_points(MessageReader& reader, const std::string& type) {
  if (is_point_cloud(type)) return parse_point_cloud(reader);
  if (is_livox(type)) return parse_livox(reader);
  throw UsageError(reader.where() + ": is of type " + type +
                   ", which has no points; expected sensor_msgs/PointCloud2 or a Livox CustomMsg.");
}

/// The places of the values of the points.
/// @param bytes the message
/// @param packed is filled with the rows of the cloud, if there is padding between them
StoredPoints stored_points(const PointsMessage& cloud, std::string_view bytes,
                           std::string& packed) {
  StoredPoints stored{bytes.substr(cloud.points_begin), {}, cloud.size(), cloud.layout.row_bytes};
  const std::uint64_t row = cloud.width * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step != row) {
    for (std::uint32_t i = 0; i < cloud.height && row > 0; ++i) {
      packed += stored.bytes.substr(i * cloud.row_step, row);
    }
    stored.bytes = packed;
  }
  for (const PointField& field : cloud.layout.fields) {
    stored.columns.push_back({field, field.offset, cloud.point_step, cloud.swapped});
  }
  return stored;
}

}  // namespace

bool has_points(const std::string& type) {
  return is_point_cloud(type) || is_livox(type);
}

PointsHead read_points_head(std::string_view bytes, const std::string& type,
                            MessageEncoding encoding, const std::string& where) {
  MessageReader reader(bytes, encoding, where);
  if (!is_livox(type)) {
    const PointsMessage cloud = parse_cloud_head(reader);
    return {cloud.header, cloud.size(), cloud.layout};
  }
  PointsHead head{read_message_header(reader), 0, livox_layout()};
  reader.number<std::uint64_t>("timebase");
  head.size = reader.number<std::uint32_t>("point_num");
  check_size(head.size, reader);
  return head;
}

PointRecords read_points(std::string_view bytes, const std::string& type, MessageEncoding encoding,
                         const std::string& where) {
  MessageReader reader(bytes, encoding, where);
  const PointsMessage cloud = parse_points(reader, type);
  std::string packed;
  PointRecords records = records_of(stored_points(cloud, bytes, packed));
  records.width = cloud.width;
  records.height = cloud.height;
  return records;
}

Cloud read_point_positions(std::string_view bytes, const std::string& type,
                           MessageEncoding encoding, const Eigen::Vector3d& origin,
                           const std::string& where) {
  MessageReader reader(bytes, encoding, where);
  const PointsMessage cloud = parse_points(reader, type);
  std::string packed;
  return cloud_of(stored_points(cloud, bytes, packed), origin, where);
}

}  // namespace raymoval
