// SPDX-License-Identifier: MIT
#include "datasets/bags/messages/point_cloud.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "datasets/bags/messages/livox.h"
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
    reader.fail("the field '" + field.name + "' is said to have " + grouped_text(count) +
                " values a point; the message looks damaged.");
  }
  field.count = static_cast<int>(count);
  return field;
}

void check_fields(const PointsMessage& cloud, const MessageReader& reader) {
  for (const PointField& field : cloud.layout.fields) {
    if (field.offset + field.bytes() <= cloud.point_step) continue;
    reader.fail("the field '" + field.name + "' ends at byte " +
                grouped_text(field.offset + field.bytes()) + " of a point, but point_step is " +
                grouped_text(cloud.point_step) + "; the publisher's layout contradicts itself.");
  }
}

/// Takes what stands in the data for its layout. `row_step` matters only where there are several
/// rows, and drivers leave it 0 or wrong otherwise.
void check_data(PointsMessage& cloud, std::uint64_t data_bytes, const MessageReader& reader) {
  const std::uint64_t row = cloud.width * cloud.point_step;
  if (cloud.height <= 1 || cloud.row_step < row) cloud.row_step = row;
  if (cloud.size() == 0) return;
  if (cloud.point_step == 0) reader.fail("point_step is 0, but there are points.");
  // One row that does not fit is enough, and the product of all could be beyond 64 bits.
  const std::uint64_t wanted = row > data_bytes ? row : cloud.row_step * (cloud.height - 1U) + row;
  if (wanted <= data_bytes) return;
  reader.fail(grouped_text(cloud.height) + " x " + grouped_text(cloud.width) + " points of " +
              grouped_text(cloud.point_step) + " bytes take " + grouped_text(wanted) +
              " bytes, but data has " + grouped_text(data_bytes) +
              "; the message is cut or contradicts itself.");
}

/// The places in a record of numbers whose bytes are to be reversed, each once.
std::vector<std::pair<std::size_t, std::size_t>> numbers_of(const RecordLayout& layout,
                                                            const std::string& where) {
  std::vector<std::pair<std::size_t, std::size_t>> numbers;
  for (const PointField& field : layout.fields) {
    const auto size = static_cast<std::size_t>(field.size);
    for (std::size_t i = 0; i < static_cast<std::size_t>(field.count); ++i) {
      numbers.emplace_back(field.offset + i * size, size);
    }
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (numbers[i - 1].first + numbers[i - 1].second <= numbers[i].first) continue;
    throw DataError(where + ": big-endian fields of different size overlap, which is not read.");
  }
  return numbers;
}

void turn_to_little_endian(PointRecords& records, const std::string& where) {
  // Without a point nothing bounds how many numbers a field says it has.
  if (records.size() == 0) return;
  const auto numbers = numbers_of(records.layout, where);
  for (std::size_t point = 0; point < records.size(); ++point) {
    for (const auto& [offset, size] : numbers) {
      std::byte* begin = records.row(point) + offset;
      std::reverse(begin, begin + size);
    }
  }
}

/// What a PointCloud2 says before its data.
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
  return cloud;
}

PointsMessage parse_points(MessageReader& reader, const std::string& type) {
  if (is_point_cloud(type)) return parse_point_cloud(reader);
  if (is_livox(type)) return parse_livox(reader);
  throw UsageError(reader.where() + ": is of type " + type +
                   ", which has no points; expected sensor_msgs/PointCloud2 or a Livox CustomMsg.");
}

}  // namespace

bool has_points(const std::string& type) {
  return is_point_cloud(type) || is_livox(type);
}

PointsHead read_points_head(std::string_view bytes, const std::string& type,
                            MessageEncoding encoding, const std::string& where) {
  MessageReader reader(bytes, encoding, where);
  PointsHead head;
  if (is_livox(type)) {
    head.header = read_message_header(reader);
    reader.number<std::uint64_t>("timebase");
    head.size = reader.number<std::uint32_t>("point_num");
    head.layout = livox_layout();
    return head;
  }
  const PointsMessage cloud = parse_cloud_head(reader);
  head.header = cloud.header;
  head.size = cloud.size();
  head.layout = cloud.layout;
  return head;
}

PointsMessage parse_point_cloud(MessageReader& reader) {
  PointsMessage cloud = parse_cloud_head(reader);
  const std::uint32_t data_bytes = reader.count("data", 1);
  cloud.points_begin = reader.position();
  reader.skip(data_bytes, "data");
  reader.number<std::uint8_t>("is_dense");
  check_fields(cloud, reader);
  check_data(cloud, data_bytes, reader);
  return cloud;
}

namespace {

/// The points with all their fields, of a message that was parsed.
PointRecords points_of(const PointsMessage& cloud, std::string_view bytes,
                       const std::string& where) {
  PointRecords records;
  records.layout = cloud.layout;
  records.width = cloud.width;
  records.height = cloud.height;
  const std::size_t row = cloud.layout.row_bytes;
  records.bytes.resize(cloud.size() * row);
  std::byte* to = records.bytes.data();
  // Points that follow each other without a gap are copied together.
  const std::uint64_t run = cloud.point_step == row ? cloud.width : 1;
  for (std::uint64_t point = 0; point < cloud.size(); point += run) {
    std::memcpy(to, bytes.data() + cloud.place(point), run * row);
    to += run * row;
  }
  if (cloud.swapped) turn_to_little_endian(records, where);
  return records;
}

/// Points that lie in `bytes` as rows of `layout`, `step` bytes apart.
StoredPoints stored_points(std::string_view bytes, const RecordLayout& layout, std::size_t step,
                           std::size_t points) {
  StoredPoints stored{bytes, {}, points, layout.row_bytes};
  for (const PointField& field : layout.fields) {
    stored.columns.push_back({field, field.offset, step, false});
  }
  return stored;
}

}  // namespace

PointRecords read_points(std::string_view bytes, const std::string& type, MessageEncoding encoding,
                         const std::string& where) {
  MessageReader reader(bytes, encoding, where);
  return points_of(parse_points(reader, type), bytes, where);
}

Cloud read_point_positions(std::string_view bytes, const std::string& type,
                           MessageEncoding encoding, const Eigen::Vector3d& origin,
                           const std::string& where) {
  MessageReader reader(bytes, encoding, where);
  const PointsMessage cloud = parse_points(reader, type);
  const bool gaps = cloud.height > 1 && cloud.row_step != cloud.width * cloud.point_step;
  if (!cloud.swapped && !gaps) {
    return cloud_of(stored_points(bytes.substr(cloud.points_begin), cloud.layout, cloud.point_step,
                                  cloud.size()),
                    origin, where);
  }
  const PointRecords points = points_of(cloud, bytes, where);
  return cloud_of(
      stored_points({reinterpret_cast<const char*>(points.bytes.data()), points.bytes.size()},
                    points.layout, points.layout.row_bytes, points.size()),
      origin, where);
}

}  // namespace raymoval
