// SPDX-License-Identifier: MIT
#include "datasets/clouds/pcd/lzf_block.h"

#include <liblzf/lzf.h>

#include <array>
#include <cstring>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {

std::string unpack_lzf_block(std::string_view body, std::uint64_t expected_bytes,
                             const std::filesystem::path& path) {
  // A back reference of 3 bytes gives at most 264.
  constexpr std::uint64_t kMostGain = 88;
  std::array<std::uint32_t, 2> sizes{};
  if (body.size() >= sizeof sizes) std::memcpy(sizes.data(), body.data(), sizeof sizes);
  const auto [packed, unpacked] = sizes;
  if (body.size() < sizeof sizes || packed > body.size() - sizeof sizes) {
    throw DataError(path.string() + ": " + grouped_text(body.size()) +
                    " bytes follow the header, but its compressed block needs " +
                    grouped_text(std::uint64_t{packed} + sizeof sizes) +
                    "; the file looks truncated. Copy it again, or leave it out with --frames.");
  }
  if (unpacked != expected_bytes) {
    throw DataError(path.string() + ": the compressed block announces " + grouped_text(unpacked) +
                    " bytes, but the header's points take " + grouped_text(expected_bytes) +
                    "; the file is damaged. Copy it again, or leave it out with --frames.");
  }
  std::string data;
  const bool plausible = unpacked <= std::uint64_t{packed} * kMostGain;
  if (plausible) data.resize(unpacked);
  if (unpacked > 0 && (!plausible || ::lzf_decompress(body.data() + sizeof sizes, packed,
                                                      data.data(), unpacked) != unpacked)) {
    throw DataError(path.string() + ": the compressed block is damaged (LZF decoding fails). " +
                    "Copy the file again, or leave it out with --frames.");
  }
  return data;
}

std::string pack_lzf_block(std::string_view data) {
  // What cannot be packed takes a byte more for each 32.
  const std::size_t room = data.size() + data.size() / 32 + 64;
  if (room > 0xFFFFFFFFU) {
    throw DataError("A compressed PCD file holds at most 4 GiB of points. Write another format.");
  }
  std::string block(2 * sizeof(std::uint32_t) + room, '\0');
  const unsigned packed =
      data.empty()
          ? 0
          : ::lzf_compress(data.data(), static_cast<unsigned>(data.size()),
                           block.data() + 2 * sizeof(std::uint32_t), static_cast<unsigned>(room));
  if (packed == 0 && !data.empty()) throw InternalError("LZF does not pack a block with room");
  const std::array sizes = {static_cast<std::uint32_t>(packed),
                            static_cast<std::uint32_t>(data.size())};
  std::memcpy(block.data(), sizes.data(), sizeof sizes);
  block.resize(sizeof sizes + packed);
  return block;
}

}  // namespace raymoval
