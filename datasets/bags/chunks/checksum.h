// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

namespace raymoval {

/// CRC-32 as zlib has it, of `bytes` behind those that gave `before`.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace raymoval
