// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// Whole file as bytes. A pipe or a device is refused without being opened.
/// @throws UnreadableError (see file_kind.h) naming the path and the system's reason; DataError if
/// there is none, if it gets shorter meanwhile, or if it is larger than the machine's memory or
/// has hardly more than holes
std::vector<std::byte> read_bytes(const std::filesystem::path& path);

/// Whole file as text, a leading UTF-8 byte order mark removed.
std::string read_text(const std::filesystem::path& path);

/// Up to `size` bytes of a file from `offset` on; fewer where it ends before. @throws as read_bytes
std::string read_piece(const std::filesystem::path& path, std::uintmax_t offset, std::size_t size);

/// Writes `content` so that `path` has either the old content or all of the new content: temporary
/// file in the same folder, fsync, rename, fsync of the folder. @throws DataError (disk full, no
/// rights).
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// For a file that a user names and that is written after long work.
/// @param shown how messages call it, such as "--json FILE"
/// @throws UsageError if its folder is missing, if it is a folder, or if it is there already and is
/// not to be replaced; DataError if it is a link that leads to no file
void check_output_file(const std::filesystem::path& path, bool overwrite, const std::string& shown);

/// JSON with // and /* */ comments. @throws ConfigurationError with line, column and reason.
nlohmann::json read_json(const std::filesystem::path& path);

/// Checks that `json` is an object whose keys are all in `allowed`.
/// @throws ConfigurationError naming `where` and suggesting the nearest legal key.
void check_keys(const nlohmann::json& json, const std::vector<std::string>& allowed,
                const std::string& where);

/// 128-bit content hash (XXH3) as 32 hexadecimal digits; for identity, not for security.
std::string content_hash(std::string_view content);

/// The same of data given piece by piece.
class ContentHasher {
 public:
  ContentHasher();
  ~ContentHasher();
  ContentHasher(const ContentHasher&) = delete;
  ContentHasher& operator=(const ContentHasher&) = delete;
  void add(const void* data, std::size_t size);
  void add(std::string_view text) { add(text.data(), text.size()); }
  [[nodiscard]] std::string digest() const;

 private:
  void* state_;
};

}  // namespace raymoval
