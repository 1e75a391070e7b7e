// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// A file in a zip archive.
struct ZipMember {
  std::string name;
  std::uint64_t packed = 0, unpacked = 0;  ///< Bytes.
  std::uint64_t offset = 0;                ///< Of its local head.
  std::uint32_t crc = 0;
  std::uint16_t method = 0, flags = 0;
};

/// The directory of a zip archive (also of the zip64 form, without several disks).
/// @param where begins the message, such as the file's path
/// @throws DataError if it is damaged
std::vector<ZipMember> zip_members(std::string_view archive, const std::string& where);

/// The content of a member that is stored or deflated.
/// @throws DataError if it is damaged (its checksum is compared), encrypted or packed in another
/// way
std::string zip_content(std::string_view archive, const ZipMember& member,
                        const std::string& where);

/// An archive with one file, with the date of an archive that has none (1980).
/// @param is_deflated whether it is packed, and not stored
/// @throws DataError beyond 4 GiB
std::string zip_archive_of(const std::string& name, std::string_view content, bool is_deflated);

}  // namespace raymoval
