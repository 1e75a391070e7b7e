// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/bags/bag.h"

namespace raymoval::test {

/// Writes a message field by field, as its publisher would: ROS 1, or CDR of either byte order.
class MessageBytes {
 public:
  explicit MessageBytes(MessageEncoding encoding, bool big_endian = false)
      : cdr_(encoding == MessageEncoding::kCdr), big_endian_(big_endian) {
    if (cdr_) bytes_ = std::string("\0\1\0\0", 4);
    if (cdr_ && big_endian) bytes_[1] = 0;
  }
  template <class Number>
  MessageBytes& number(Number value) {
    while (cdr_ && (bytes_.size() - 4) % sizeof value != 0) bytes_.push_back('\0');
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big_endian_) std::reverse(raw, raw + sizeof value);
    bytes_.append(raw, sizeof value);
    return *this;
  }
  MessageBytes& u8(unsigned value) { return number(static_cast<std::uint8_t>(value)); }
  MessageBytes& u32(std::uint32_t value) { return number(value); }
  MessageBytes& f32(float value) { return number(value); }
  MessageBytes& f64(double value) { return number(value); }
  MessageBytes& text(const std::string& value) {
    u32(static_cast<std::uint32_t>(value.size()) + (cdr_ ? 1 : 0));
    return raw(value + (cdr_ ? std::string(1, '\0') : ""));
  }
  MessageBytes& raw(const std::string& value) {
    bytes_ += value;
    return *this;
  }
  MessageBytes& header(std::uint32_t seconds, std::uint32_t nanoseconds, const std::string& frame) {
    if (!cdr_) u32(5);
    return u32(seconds).u32(nanoseconds).text(frame);
  }
  /// A position x y z and a quaternion x y z w.
  MessageBytes& motion(const std::vector<double>& values) {
    for (const double value : values) f64(value);
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  bool cdr_, big_endian_;
  std::string bytes_;
};

/// A field of a PointCloud2: its name, offset, number of its type, and count.
struct CloudField {
  std::string name;
  std::uint32_t offset;
  unsigned type;
  std::uint32_t count = 1;
};

/// All of a PointCloud2 but its points.
struct CloudHead {
  std::uint32_t seconds = 1000, nanoseconds = 0;
  std::string frame = "lidar";
  std::uint32_t height = 1, width = 0;
  std::vector<CloudField> fields = {{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}};
  bool big_endian = false;
  std::uint32_t point_step = 12, row_step = 0;
};

inline std::string cloud_message(MessageBytes message, const CloudHead& head,
                                 const std::string& data) {
  message.header(head.seconds, head.nanoseconds, head.frame).u32(head.height).u32(head.width);
  message.u32(static_cast<std::uint32_t>(head.fields.size()));
  for (const CloudField& field : head.fields) {
    message.text(field.name).u32(field.offset).u8(field.type).u32(field.count);
  }
  message.u8(head.big_endian ? 1 : 0).u32(head.point_step).u32(head.row_step);
  return message.u32(static_cast<std::uint32_t>(data.size())).raw(data).u8(1).bytes();
}

}  // namespace raymoval::test
