// SPDX-License-Identifier: MIT
#include "core/files/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/strict_json.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::string system_reason() {
  return std::generic_category().message(errno);
}

/// A plain file that is open for reading, and its size.
struct OpenFile {
  Descriptor file;
  std::uintmax_t size = 0;
};

OpenFile open_plain(const std::filesystem::path& path) {
  // Opening a pipe would block and opening a device may have effects, so these are not opened. The
  // call does not block either if the name becomes one of these between the two calls.
  if (is_folder(path)) throw DataError(path.string() + ": is a folder, expected a file.");
  OpenFile opened{Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY))};
  struct stat status {};
  if (!opened.file.valid() || ::fstat(opened.file.get(), &status) != 0) {
    const std::string problem = path.string() + ": cannot be read (" + system_reason() + ").";
    if (means_absent(errno)) throw DataError(problem);
    throw UnreadableError(problem);
  }
  if (!S_ISREG(status.st_mode)) throw DataError(path.string() + ": is not a regular file.");
  opened.size = static_cast<std::uintmax_t>(status.st_size);
  return opened;
}

/// Fills `content` from `offset` on. @throws DataError if the file ends before
template <class Container>
void read_into(const OpenFile& opened, std::uintmax_t offset, Container& content,
               const std::filesystem::path& path) {
  const auto got = read_at(opened.file.get(), content.data(), content.size(), offset);
  if (!got) throw UnreadableError(path.string() + ": reading failed (" + system_reason() + ").");
  if (*got == content.size()) return;
  throw DataError(
      path.string() +
      ": became shorter while it was read. Wait until the program that writes it has ended.");
}

/// Refuses a file that cannot be read whole. An interrupted copy may have any size, but has holes.
void check_can_be_read_whole(const OpenFile& opened, const std::filesystem::path& path) {
  constexpr std::uintmax_t kLarge = std::uintmax_t{1} << 30;
  if (opened.size < kLarge) return;
  struct stat status {};
  const bool known = ::fstat(opened.file.get(), &status) == 0;
  const bool holes = known && static_cast<std::uintmax_t>(status.st_blocks) * 512 < opened.size / 8;
  const auto memory = static_cast<std::uintmax_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES))) *
                      static_cast<std::uintmax_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
  if (!holes && opened.size <= memory) return;
  throw DataError(
      path.string() + ": has " + grouped_text(opened.size) + " bytes, " +
      (holes ? "most of which were never written: the copy seems incomplete. Copy it again."
             : "more than the memory of this machine. Check that it is the file you "
               "mean."));
}

template <class Container>
Container read_all(const std::filesystem::path& path) {
  const OpenFile opened = open_plain(path);
  check_can_be_read_whole(opened, path);
  Container content(static_cast<std::size_t>(opened.size), typename Container::value_type{});
  read_into(opened, 0, content, path);
  return content;
}

}  // namespace

std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  return read_all<std::vector<std::byte>>(path);
}

std::string read_text(const std::filesystem::path& path) {
  auto text = read_all<std::string>(path);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

std::string read_piece(const std::filesystem::path& path, std::uintmax_t offset, std::size_t size) {
  const OpenFile opened = open_plain(path);
  const std::uintmax_t left = opened.size - std::min(offset, opened.size);
  std::string piece(static_cast<std::size_t>(std::min<std::uintmax_t>(size, left)), '\0');
  read_into(opened, offset, piece, path);
  return piece;
}

void write_atomically(const std::filesystem::path& path, std::string_view content) {
  FileWriter file(path);
  file.append(content);
  file.commit();
}

void check_output_file(const std::filesystem::path& path, bool overwrite,
                       const std::string& shown) {
  const std::filesystem::path folder = folder_of(path);
  if (!is_folder(folder)) {
    throw UsageError(path.string() + ": there is no folder " + folder.string() +
                     ". Make it first.");
  }
  (void)output_target(path);
  const FileKind there = file_kind(path);
  if (there == FileKind::kFolder) {
    throw UsageError(shown + ": is a folder, expected a file name.");
  }
  if (there == FileKind::kFile && !overwrite) {
    throw UsageError(shown +
                     ": is there already; choose another name, or replace it with --overwrite.");
  }
}

nlohmann::json read_json(const std::filesystem::path& path) {
  return parse_json(read_text(path), path.string());
}

void check_keys(const nlohmann::json& json, const std::vector<std::string>& allowed,
                const std::string& where) {
  if (!json.is_object()) {
    throw ConfigurationError(where + ": expected an object { ... } with the keys " + join(allowed) +
                             ".");
  }
  for (const auto& [key, value] : json.items()) {
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
      throw ConfigurationError(where + ": unknown key '" + key + "'." + suggestion(key, allowed));
    }
  }
}

ContentHasher::ContentHasher() : state_(XXH3_createState()) {
  if (state_ == nullptr) throw std::bad_alloc();
  XXH3_128bits_reset(static_cast<XXH3_state_t*>(state_));
}

ContentHasher::~ContentHasher() {
  XXH3_freeState(static_cast<XXH3_state_t*>(state_));
}

void ContentHasher::add(const void* data, std::size_t size) {
  XXH3_128bits_update(static_cast<XXH3_state_t*>(state_), data, size);
}

std::string ContentHasher::digest() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(static_cast<XXH3_state_t*>(state_)));
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string content_hash(std::string_view content) {
  ContentHasher hasher;
  hasher.add(content);
  return hasher.digest();
}

}  // namespace raymoval
