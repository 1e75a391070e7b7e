// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "datasets/bags/chunks/message_table.h"
#include "datasets/bags/damage_notes.h"
#include "datasets/bags/ros1/chunk.h"

namespace raymoval {

/// What a ROS 1 bag holds, without its messages.
struct Ros1Contents {
  std::map<std::uint32_t, Ros1Connection> connections;
  std::map<std::uint32_t, std::size_t> topics;  ///< Topic in `messages` of each connection.
  std::vector<Ros1Chunk> chunks;                ///< In the order of the file.
  MessageTable messages;                        ///< Places are those of `message_place`.
};

/// A message's chunk and its byte there in one number, which grows along the file. A chunk unpacks
/// to less than 4 GiB, for its size has 32 bits.
constexpr std::uint64_t message_place(std::size_t chunk, std::uint64_t offset) {
  return (static_cast<std::uint64_t>(chunk) << 32U) | offset;
}
constexpr std::size_t chunk_of(std::uint64_t place) {
  return static_cast<std::size_t>(place >> 32U);
}
constexpr std::uint64_t offset_of(std::uint64_t place) {
  return place & 0xFFFFFFFFU;
}

/// Reads what is in a bag. From its index, if that is whole and fits what it points to; else chunk
/// by chunk from front to back, as far as the file goes.
/// @param notes gets what could not be read
/// @throws DataError if the file is no ROS 1 bag of version 2.0, or encrypted; UnreadableError if
///   the disk fails
Ros1Contents read_contents(const BagFile& file, DamageNotes& notes);

}  // namespace raymoval
