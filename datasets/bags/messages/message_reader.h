// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "datasets/bags/bag.h"

namespace raymoval {

/// Reads the fields of a message one after another, in the order of its definition. The encoding is
/// ROS 1 serialisation, or CDR of either byte order. CDR aligns numbers to multiples of their size,
/// counted from the end of its head of four bytes. A read beyond the end is an error that names the
/// message, the field and the byte.
class MessageReader {
 public:
  /// @param where begins messages: "drive.bag: /points, message 12"
  /// @throws DataError for an encoding other than these, or CDR of another kind (XCDR2, parameter
  ///   lists)
  MessageReader(std::string_view bytes, MessageEncoding encoding, std::string where);

  /// The next number.
  template <class Number>
  Number number(const char* field) {
    align(sizeof(Number));
    char bytes[sizeof(Number)];
    std::memcpy(bytes, take(sizeof(Number), field).data(), sizeof(Number));
    if (big_endian_) std::reverse(bytes, bytes + sizeof(Number));
    Number value;
    std::memcpy(&value, bytes, sizeof(Number));
    return value;
  }
  /// The next text.
  std::string text(const char* field);
  /// The length of the sequence that follows. @param least smallest size of an element, bytes
  std::uint32_t count(const char* field, std::size_t least);
  /// The next `size` bytes, unchanged.
  std::string_view take(std::size_t size, const char* field);
  void skip(std::size_t size, const char* field) { take(size, field); }

  /// The next byte to read.
  [[nodiscard]] std::size_t position() const { return position_; }
  /// The byte at which the next number of `size` bytes begins.
  [[nodiscard]] std::size_t aligned_position(std::size_t size) const;
  void align(std::size_t size) { position_ = aligned_position(size); }
  [[nodiscard]] std::string_view bytes() const { return bytes_; }
  [[nodiscard]] bool big_endian() const { return big_endian_; }
  [[nodiscard]] bool is_cdr() const { return is_cdr_; }
  [[nodiscard]] const std::string& where() const { return where_; }
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view bytes_;
  std::string where_;
  std::size_t position_ = 0;
  bool is_cdr_ = false, big_endian_ = false;
};

/// A std_msgs/Header.
struct MessageHeader {
  Nanoseconds stamp = 0;
  std::string frame_id;
};
MessageHeader read_message_header(MessageReader& reader);

/// Number of bytes that hold the header of a message and the numbers behind it, for frame names of
/// any usual length.
inline constexpr std::size_t kHeaderBytes = 1024;

}  // namespace raymoval
