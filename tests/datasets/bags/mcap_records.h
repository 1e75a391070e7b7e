// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/bags/mcap/mcap_file.h"

/// Makes the records of MCAP files.
namespace raymoval::test::mcap {

/// A number with its lowest byte first.
template <class Number>
inline std::string number(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

inline std::string text(std::string_view text) {
  return number(static_cast<std::uint32_t>(text.size())) + std::string(text);
}

inline std::string record(McapOp op, const std::string& content) {
  return number(op) + number(std::uint64_t{content.size()}) + content;
}

/// A file of records, without a summary.
inline std::string mcap_of(const std::vector<std::pair<McapOp, std::string>>& records) {
  std::string bytes(kMcapMagic);
  for (const auto& [op, content] : records) bytes += record(op, content);
  return bytes + record(McapOp::kFooter, std::string(20, '\0')) + std::string(kMcapMagic);
}

inline std::string schema(std::uint16_t id, std::string_view name) {
  return number(id) + text(name) + text("ros2msg") + text("");
}

inline std::string channel(std::uint16_t id, std::uint16_t of, std::string_view topic,
                           std::string_view encoding) {
  return number(id) + number(of) + text(topic) + text(encoding) + text("");
}

inline std::string message(std::uint16_t of, std::uint64_t time, std::string_view content) {
  return number(of) + number(std::uint32_t{0}) + number(time) + number(time) + std::string(content);
}

inline std::string chunk(std::string_view compression, std::uint64_t unpacked, std::uint32_t crc,
                         std::string_view packed) {
  return number(std::uint64_t{0}) + number(std::uint64_t{0}) + number(unpacked) + number(crc) +
         text(compression) + number(std::uint64_t{packed.size()}) + std::string(packed);
}

}  // namespace raymoval::test::mcap
