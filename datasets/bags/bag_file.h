// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/files/descriptor.h"

namespace raymoval {

/// A file of a recording, open for reading at any place by any thread.
class BagFile {
 public:
  /// @throws DataError if `path` is no file, UnreadableError if it cannot be opened
  explicit BagFile(std::filesystem::path path);
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Bytes of the file when it was opened. Bytes appended later are ignored.
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Exactly these bytes. @throws DataError naming the byte if the file ends before, without
  ///   allocating memory; UnreadableError if the disk fails
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t size) const;
  /// As many of these bytes as there are; none behind the end. @throws UnreadableError
  [[nodiscard]] std::string read_up_to(std::uint64_t offset, std::uint64_t size) const;
  /// "name.bag: byte 4,117", to begin messages.
  [[nodiscard]] std::string place(std::uint64_t offset) const;

 private:
  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t size_ = 0;
};

/// CRC-32 of zlib. `before` is the CRC of the bytes before `bytes`.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

}  // namespace raymoval
