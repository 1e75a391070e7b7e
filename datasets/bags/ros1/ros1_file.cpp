// SPDX-License-Identifier: MIT
#include "datasets/bags/ros1/ros1_file.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Largest size of a header, bytes. The type definition of a connection is in its data.
constexpr std::uint32_t kLongestHeader = 1U << 20U;
/// Largest size of a connection's data, bytes: its type definition, usually a few KiB.
constexpr std::uint32_t kLongestConnection = 1U << 24U;
constexpr std::uint64_t kLength = sizeof(std::uint32_t);
/// Most headers are shorter than this, so one read gives a header and both lengths.
constexpr std::uint64_t kFirstPiece = 128;

constexpr std::array<std::string_view, 3> kCompressionNames = {"none", "bz2", "lz4"};

[[noreturn]] void throw_truncated(const std::string& place, std::uint64_t wanted,
                                  std::uint64_t there, const char* what) {
  throw DataError(place + ": " + what + " takes " + grouped_text(wanted) + " bytes, but " +
                  grouped_text(there) + " are left; the file is truncated or damaged there.");
}

/// The bytes of the field `name`; empty if there is none.
/// @throws DataError beginning with `where` if a length does not fit or a field has no name
std::optional<std::string> find_field(std::string_view header, std::string_view name,
                                      const std::string& where) {
  std::optional<std::string> found;
  while (!header.empty()) {
    const std::uint64_t size =
        header.size() < kLength ? 0 : little_endian<std::uint32_t>(header, 0);
    if (header.size() < kLength || size > header.size() - kLength) {
      throw DataError(where +
                      ": a field of the header reaches beyond its end; the file looks "
                      "damaged.");
    }
    const std::string_view field = header.substr(kLength, size);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      throw DataError(where + ": a field of the header is not NAME=VALUE; the file looks damaged.");
    }
    if (field.substr(0, equals) == name && !found) found = std::string(field.substr(equals + 1));
    header.remove_prefix(kLength + size);
  }
  return found;
}

/// The bytes of a required field.
std::string text_field(std::string_view header, std::string_view name, const std::string& where) {
  if (auto found = find_field(header, name, where)) return *std::move(found);
  throw DataError(where + ": the header has no field '" + std::string(name) +
                  "'; the file looks damaged.");
}

/// The bytes of a required field of `size` bytes.
std::string sized_field(const Ros1Record& record, std::string_view name, std::size_t size) {
  std::string text = record.text(name);
  if (text.size() == size) return text;
  throw DataError(record.where + ": the field '" + std::string(name) + "' has " +
                  counted_text(text.size(), "byte") + ", expected " + std::to_string(size) +
                  "; the file looks damaged.");
}

}  // namespace

Ros1Op Ros1Record::op() const {
  return static_cast<Ros1Op>(sized_field(*this, "op", 1)[0]);
}

std::uint32_t Ros1Record::u32(std::string_view field) const {
  return little_endian<std::uint32_t>(sized_field(*this, field, 4), 0);
}

std::uint64_t Ros1Record::u64(std::string_view field) const {
  return little_endian<std::uint64_t>(sized_field(*this, field, 8), 0);
}

Nanoseconds Ros1Record::time(std::string_view field) const {
  return ros1_time(sized_field(*this, field, 8), 0);
}

std::string Ros1Record::text(std::string_view field) const {
  return text_field(header, field, where);
}

std::optional<std::string> Ros1Record::find(std::string_view field) const {
  return find_field(header, field, where);
}

std::string Ros1Bytes::read(std::uint64_t offset, std::uint64_t count) const {
  if (file_ != nullptr) return file_->read(begin_ + offset, count);
  return std::string(unpacked_.substr(offset, count));
}

std::string Ros1Bytes::place(std::uint64_t offset) const {
  if (file_ != nullptr) return file_->place(begin_ + offset);
  return chunk_place_ + ": byte " + grouped_text(offset) + " of the decompressed chunk";
}

Ros1Record read_record(const Ros1Bytes& bytes, std::uint64_t offset) {
  const std::uint64_t left = bytes.size() - std::min(offset, bytes.size());
  const std::string first = bytes.read(offset, std::min(left, kFirstPiece));
  if (left < kLength) throw_truncated(bytes.place(offset), kLength, left, "the length of a record");
  const auto header_size = little_endian<std::uint32_t>(first, 0);
  if (header_size > kLongestHeader) {
    throw DataError(bytes.place(offset) + ": a record's header should have " +
                    grouped_text(header_size) +
                    " bytes, more than any has; the file looks damaged there.");
  }
  const std::uint64_t wanted = 2 * kLength + header_size;
  if (wanted > left) throw_truncated(bytes.place(offset), wanted, left, "the header of a record");
  const std::string all = wanted <= first.size() ? first : bytes.read(offset, wanted);
  Ros1Record record;
  record.begin = offset;
  record.where = bytes.place(offset);
  record.header = all.substr(kLength, header_size);
  record.data_begin = offset + wanted;
  record.data_size = little_endian<std::uint32_t>(all, kLength + header_size);
  return record;
}

void check_data_is_there(const Ros1Bytes& bytes, const Ros1Record& record) {
  if (record.end() <= bytes.size()) return;
  throw_truncated(bytes.place(record.data_begin), record.data_size,
                  bytes.size() - record.data_begin, "the data of a record");
}

std::optional<Ros1Record> next_in_chunk(const Ros1Bytes& bytes, std::uint64_t& at) {
  while (at < bytes.size()) {
    Ros1Record found = read_record(bytes, at);
    check_data_is_there(bytes, found);
    at = found.end();
    if (found.op() == Ros1Op::kMessage || found.op() == Ros1Op::kConnection) return found;
  }
  return std::nullopt;
}

Nanoseconds ros1_time(std::string_view bytes, std::size_t offset) {
  constexpr Nanoseconds kSecond = 1'000'000'000;
  return kSecond * little_endian<std::uint32_t>(bytes, offset) +
         little_endian<std::uint32_t>(bytes, offset + 4);
}

Ros1Connection read_connection(const Ros1Bytes& bytes, const Ros1Record& record) {
  check_data_is_there(bytes, record);
  if (record.data_size > kLongestConnection) {
    throw DataError(record.where + ": a connection should have " + grouped_text(record.data_size) +
                    " bytes, more than any has; the file looks damaged.");
  }
  const std::string fields = bytes.read(record.data_begin, record.data_size);
  return {record.u32("conn"), record.text("topic"), text_field(fields, "type", record.where),
          find_field(fields, "md5sum", record.where).value_or("")};
}

Ros1Chunk read_chunk(const Ros1Bytes& file, const Ros1Record& record) {
  const std::string name = record.text("compression");
  const auto known = std::find(kCompressionNames.begin(), kCompressionNames.end(), name);
  if (known == kCompressionNames.end()) {
    throw DataError(record.where + ": the compression '" + name +
                    "' of a chunk is unknown; expected none, bz2 or lz4. Try: rosbag decompress.");
  }
  Ros1Chunk chunk;
  chunk.begin = record.begin;
  chunk.data_begin = record.data_begin;
  chunk.compression = static_cast<Ros1Compression>(known - kCompressionNames.begin());
  chunk.size = record.u32("size");
  chunk.cut = record.end() > file.size();
  chunk.packed =
      chunk.cut ? static_cast<std::uint32_t>(file.size() - record.data_begin) : record.data_size;
  if (chunk.compression != Ros1Compression::kNone) {
    check_decompressed_size(record.data_size, chunk.size, record.where + ": a chunk");
  } else if (chunk.size != record.data_size) {
    throw DataError(record.where + ": an uncompressed chunk has " + grouped_text(record.data_size) +
                    " bytes, but should have " + grouped_text(chunk.size) +
                    "; the file looks damaged.");
  }
  return chunk;
}

Decompressed decompress_chunk(const BagFile& file, const Ros1Chunk& chunk) {
  const std::string packed = file.read(chunk.data_begin, chunk.packed);
  // The limit of the whole chunk was checked with its head; a truncated chunk has fewer bytes and a
  // lower limit.
  const std::uint64_t most =
      chunk.cut ? std::min<std::uint64_t>(chunk.size, most_decompressed_size(packed.size()))
                : chunk.size;
  const std::string where = file.place(chunk.begin) + ": a chunk";
  return chunk.compression == Ros1Compression::kBz2 ? decompress_bz2(packed, most, where)
                                                    : decompress_lz4(packed, most, where);
}

}  // namespace raymoval
