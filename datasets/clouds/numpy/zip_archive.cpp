// SPDX-License-Identifier: MIT
#include "datasets/clouds/numpy/zip_archive.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/deflate.h"

namespace raymoval {
namespace {

// Sizes and signatures as PKWARE's APPNOTE.TXT gives them.
constexpr std::size_t kEndBytes = 22, kLocatorBytes = 20, kEnd64Bytes = 56, kEntryBytes = 46,
                      kLocalBytes = 30;
constexpr std::uint32_t kMany = 0xFFFFFFFFU;

class ZipReader {
 public:
  ZipReader(std::string_view archive, const std::string& where)
      : archive_(archive), where_(where) {}

  std::vector<ZipMember> members() {
    find_directory();
    std::vector<ZipMember> all;
    for (std::uint64_t i = 0; i < entries_; ++i) all.push_back(read_entry());
    return all;
  }

  template <class Number>
  Number number(std::uint64_t at) const {
    Number value{};
    std::memcpy(&value, piece(at, sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view piece(std::uint64_t at, std::uint64_t bytes) const {
    if (at > archive_.size() || bytes > archive_.size() - at) fail("it refers beyond its end");
    return archive_.substr(at, bytes);
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw DataError(where_ + ": the zip archive is damaged: " + what +
                    ". Copy it again, or save it again.");
  }

 private:
  /// The end record stands last, with a comment of up to 65,535 bytes behind it.
  void find_directory() {
    const std::size_t least = archive_.size() - std::min<std::size_t>(archive_.size(), 65557);
    std::size_t end = std::string_view::npos;
    if (archive_.size() >= kEndBytes)
      end = archive_.rfind("PK\x05\x06", archive_.size() - kEndBytes);
    if (end == std::string_view::npos || end < least) {
      fail("it has no directory; it looks truncated, or is no zip archive");
    }
    entries_ = number<std::uint16_t>(end + 10);
    at_ = number<std::uint32_t>(end + 16);
    const bool zip64 = end >= kLocatorBytes &&
                       archive_.substr(end - kLocatorBytes, 4) == std::string_view("PK\x06\x07");
    if (zip64 && (entries_ == 0xFFFF || at_ == kMany)) {
      const auto end64 = number<std::uint64_t>(end - kLocatorBytes + 8);
      if (piece(end64, kEnd64Bytes).substr(0, 4) != std::string_view("PK\x06\x06")) {
        fail("its zip64 record is missing");
      }
      entries_ = number<std::uint64_t>(end64 + 32);
      at_ = number<std::uint64_t>(end64 + 48);
    }
    if (entries_ > archive_.size() / kEntryBytes) fail("its directory announces too many files");
  }

  ZipMember read_entry() {
    if (piece(at_, kEntryBytes).substr(0, 4) != std::string_view("PK\x01\x02")) {
      fail("an entry of its directory is missing");
    }
    ZipMember member;
    member.flags = number<std::uint16_t>(at_ + 8);
    member.method = number<std::uint16_t>(at_ + 10);
    member.crc = number<std::uint32_t>(at_ + 16);
    member.packed = number<std::uint32_t>(at_ + 20);
    member.unpacked = number<std::uint32_t>(at_ + 24);
    const auto name_bytes = number<std::uint16_t>(at_ + 28);
    const auto extra_bytes = number<std::uint16_t>(at_ + 30);
    const auto comment_bytes = number<std::uint16_t>(at_ + 32);
    member.offset = number<std::uint32_t>(at_ + 42);
    member.name = piece(at_ + kEntryBytes, name_bytes);
    read_extra(at_ + kEntryBytes + name_bytes, extra_bytes, member);
    at_ += kEntryBytes + name_bytes + extra_bytes + comment_bytes;
    return member;
  }

  /// zip64: the numbers that 32 bits cannot hold stand in a block of their own.
  void read_extra(std::uint64_t at, std::uint64_t bytes, ZipMember& member) const {
    (void)piece(at, bytes);
    const std::uint64_t end = at + bytes;
    while (end - at >= 4) {
      const auto kind = number<std::uint16_t>(at);
      std::uint64_t value = at + 4;
      at = std::min<std::uint64_t>(end, value + number<std::uint16_t>(at + 2));
      if (kind != 1) continue;
      for (std::uint64_t* wide : {&member.unpacked, &member.packed, &member.offset}) {
        if (*wide != kMany || at - value < 8) continue;
        *wide = number<std::uint64_t>(value);
        value += 8;
      }
    }
  }

  std::string_view archive_;
  const std::string& where_;
  std::uint64_t entries_ = 0, at_ = 0;
};

}  // namespace

std::vector<ZipMember> zip_members(std::string_view archive, const std::string& where) {
  return ZipReader(archive, where).members();
}

std::string zip_archive_of(const std::string& name, std::string_view content, bool is_deflated) {
  const std::string packed = is_deflated ? deflate_member(content) : std::string(content);
  constexpr std::size_t kMost = 0xFFFFFFFFU - 65536;
  if (content.size() > kMost || packed.size() > kMost) {
    throw DataError(name + ": an archive of more than 4 GiB is not written. Choose fewer points.");
  }
  std::string archive;
  const auto put = [&](std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) archive += static_cast<char>((value >> (8 * i)) & 0xFFU);
  };
  // What the head of a file and its entry in the directory have in common.
  const auto put_about = [&] {
    constexpr std::uint64_t kVersion = 20, kNoFlags = 0, kFirstDay = 0x0021;
    put(kVersion, 2);
    put(kNoFlags, 2);
    put(is_deflated ? 8 : 0, 2);
    put(0, 2);
    put(kFirstDay, 2);
    put(crc32_of(content), 4);
    put(packed.size(), 4);
    put(content.size(), 4);
    put(name.size(), 2);
    put(0, 2);
  };
  archive = "PK\x03\x04";
  put_about();
  archive += name + packed;
  const std::size_t directory = archive.size();
  archive += "PK\x01\x02";
  put(20, 2);
  put_about();
  // No comment, first disk, no attributes, and its head at the begin.
  for (const int bytes : {2, 2, 2, 4, 4}) put(0, bytes);
  archive += name;
  const std::size_t end = archive.size();
  archive += "PK\x05\x06";
  put(0, 4);
  put(1, 2);
  put(1, 2);
  put(end - directory, 4);
  put(directory, 4);
  put(0, 2);
  return archive;
}

std::string zip_content(std::string_view archive, const ZipMember& member,
                        const std::string& where) {
  const ZipReader reader(archive, where);
  if (reader.piece(member.offset, kLocalBytes).substr(0, 4) != std::string_view("PK\x03\x04")) {
    reader.fail("a file in it has no head");
  }
  if ((member.flags & 1U) != 0) {
    throw DataError(where + ": is encrypted. Save it without a password.");
  }
  const auto name_bytes = reader.number<std::uint16_t>(member.offset + 26);
  const auto extra_bytes = reader.number<std::uint16_t>(member.offset + 28);
  const std::string_view packed =
      reader.piece(member.offset + kLocalBytes + name_bytes + extra_bytes, member.packed);
  std::string content;
  if (member.method == 8) {
    content = inflate_member(packed, member.unpacked, where);
  } else if (member.method == 0) {
    content = packed;
  } else {
    throw DataError(where + ": is packed by method " + std::to_string(member.method) +
                    " of zip, which is not read; numpy.savez and savez_compressed write others.");
  }
  if (content.size() != member.unpacked || crc32_of(content) != member.crc) {
    reader.fail("the checksum of a file in it differs");
  }
  return content;
}

}  // namespace raymoval
