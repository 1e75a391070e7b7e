// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/files/descriptor.h"

namespace raymoval {

/// Writes all of `content` to a file, from byte `offset` on.
/// @return false, with the reason in errno, if that is not possible
bool write_at(int file, std::string_view content, std::uint64_t offset);

/// Reads up to `size` bytes of a file, from byte `offset` on; fewer if the file ends before.
/// @return the number of bytes, or nothing, with the reason in errno, if they cannot be read
std::optional<std::size_t> read_at(int file, void* data, std::size_t size, std::uint64_t offset);

/// The same as a text. What cannot be read is left out.
std::string read_at(int file, std::size_t size, std::uint64_t offset);

/// Makes a file that lives in memory. It vanishes when no process has it open any more.
/// @throws DataError if the system has no memory for it
Descriptor memory_file(const char* name);

}  // namespace raymoval
