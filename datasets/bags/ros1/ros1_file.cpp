// SPDX-License-Identifier: MIT
#include "datasets/bags/ros1/ros1_file.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// The most that a header has. A connection's definition of its type stands in its data.
constexpr std::uint32_t kLongestHeader = 1U << 20U;
/// The most that a connection's data has: the definition of its type, a few KiB.
constexpr std::uint32_t kLongestConnection = 1U << 24U;
constexpr std::uint64_t kLength = sizeof(std::uint32_t);
/// Most headers are shorter than this, so one reading gives a header and both lengths.
constexpr std::uint64_t kFirstPiece = 128;

std::string header_text(std::string_view header, std::string_view name, std::size_t size,
                        const std::string& where) {
  std::string text = text_field(header, name, where);
  if (text.size() == size) return text;
  throw DataError(where + ": the field '" + std::string(name) + "' has " +
                  counted_text(text.size(), "byte") + ", expected " + std::to_string(size) +
                  "; the file looks damaged.");
}

[[noreturn]] void throw_cut(const std::string& place, std::uint64_t wanted, std::uint64_t there,
                            const char* what) {
  throw DataError(place + ": " + what + " takes " + grouped_text(wanted) + " bytes, but " +
                  grouped_text(there) + " are left; the file is cut or damaged there.");
}

}  // namespace

std::string Ros1ChunkBytes::place(std::uint64_t offset) const {
  return chunk_place_ + ": byte " + grouped_text(offset) + " of the unpacked chunk";
}

Ros1Record read_record(const Ros1Bytes& bytes, std::uint64_t offset) {
  const std::uint64_t left = bytes.size() - std::min(offset, bytes.size());
  const std::string first = bytes.read(offset, std::min(left, kFirstPiece));
  if (left < kLength) throw_cut(bytes.place(offset), kLength, left, "the length of a record");
  const auto header_size = little_endian<std::uint32_t>(first, 0);
  if (header_size > kLongestHeader) {
    throw DataError(bytes.place(offset) + ": a record's header is said to have " +
                    grouped_text(header_size) +
                    " bytes, more than any has; the file looks damaged there.");
  }
  const std::uint64_t wanted = 2 * kLength + header_size;
  if (wanted > left) throw_cut(bytes.place(offset), wanted, left, "the header of a record");
  const std::string all = wanted <= first.size() ? first : bytes.read(offset, wanted);
  Ros1Record record;
  record.header = all.substr(kLength, header_size);
  record.data_begin = offset + wanted;
  record.data_size = little_endian<std::uint32_t>(all, kLength + header_size);
  return record;
}

void check_data_is_there(const Ros1Bytes& bytes, const Ros1Record& record) {
  if (record.end() <= bytes.size()) return;
  throw_cut(bytes.place(record.data_begin), record.data_size, bytes.size() - record.data_begin,
            "the data of a record");
}

void for_each_field(
    std::string_view header, const std::string& where,
    const std::function<void(std::string_view name, std::string_view value)>& call) {
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
    call(field.substr(0, equals), field.substr(equals + 1));
    header.remove_prefix(kLength + size);
  }
}

std::optional<std::string> find_field(std::string_view header, std::string_view name,
                                      const std::string& where) {
  std::optional<std::string> found;
  for_each_field(header, where, [&](std::string_view field, std::string_view value) {
    if (field == name && !found) found = std::string(value);
  });
  return found;
}

std::string text_field(std::string_view header, std::string_view name, const std::string& where) {
  if (auto found = find_field(header, name, where)) return *std::move(found);
  throw DataError(where + ": the header has no field '" + std::string(name) +
                  "'; the file looks damaged.");
}

std::uint32_t u32_field(std::string_view header, std::string_view name, const std::string& where) {
  return little_endian<std::uint32_t>(header_text(header, name, 4, where), 0);
}

std::uint64_t u64_field(std::string_view header, std::string_view name, const std::string& where) {
  return little_endian<std::uint64_t>(header_text(header, name, 8, where), 0);
}

Nanoseconds time_field(std::string_view header, std::string_view name, const std::string& where) {
  return ros1_time(header_text(header, name, 8, where), 0);
}

Ros1Op op_of(const Ros1Record& record, const std::string& where) {
  return static_cast<Ros1Op>(header_text(record.header, "op", 1, where)[0]);
}

Nanoseconds ros1_time(std::string_view bytes, std::size_t offset) {
  constexpr Nanoseconds kSecond = 1'000'000'000;
  return kSecond * little_endian<std::uint32_t>(bytes, offset) +
         little_endian<std::uint32_t>(bytes, offset + 4);
}

Ros1Connection read_connection(const Ros1Bytes& bytes, const Ros1Record& record,
                               const std::string& where) {
  check_data_is_there(bytes, record);
  if (record.data_size > kLongestConnection) {
    throw DataError(where + ": a connection is said to have " + grouped_text(record.data_size) +
                    " bytes, more than any has; the file looks damaged.");
  }
  Ros1Connection connection;
  connection.id = u32_field(record.header, "conn", where);
  connection.topic = text_field(record.header, "topic", where);
  connection.fields = bytes.read(record.data_begin, record.data_size);
  connection.type = text_field(connection.fields, "type", where);
  connection.md5 = find_field(connection.fields, "md5sum", where).value_or("");
  return connection;
}

namespace {

constexpr std::array kCompressions = {Ros1Compression::kNone, Ros1Compression::kBz2,
                                      Ros1Compression::kLz4};

Ros1Compression compression_named(const std::string& name, const std::string& where) {
  for (const Ros1Compression compression : kCompressions) {
    if (ros1_compression_name(compression) == name) return compression;
  }
  throw DataError(where + ": the compression '" + name +
                  "' of a chunk is unknown; expected none, bz2 or lz4. Try: rosbag decompress.");
}

}  // namespace

std::string_view ros1_compression_name(Ros1Compression compression) {
  switch (compression) {
    case Ros1Compression::kBz2:
      return "bz2";
    case Ros1Compression::kLz4:
      return "lz4";
    case Ros1Compression::kNone:
      break;
  }
  return "none";
}

Ros1Chunk read_chunk(const Ros1Bytes& file, const Ros1Record& record, std::uint64_t begin) {
  const std::string where = file.place(begin);
  Ros1Chunk chunk;
  chunk.begin = begin;
  chunk.data_begin = record.data_begin;
  chunk.compression = compression_named(text_field(record.header, "compression", where), where);
  chunk.size = u32_field(record.header, "size", where);
  chunk.cut = record.end() > file.size();
  chunk.packed =
      chunk.cut ? static_cast<std::uint32_t>(file.size() - record.data_begin) : record.data_size;
  if (chunk.compression == Ros1Compression::kNone && chunk.size != record.data_size) {
    throw DataError(where + ": a chunk that is not packed has " + grouped_text(record.data_size) +
                    " bytes, but is said to have " + grouped_text(chunk.size) +
                    "; the file looks damaged.");
  }
  if (chunk.compression != Ros1Compression::kNone) {
    check_unpacked_size(record.data_size, chunk.size, where + ": a chunk");
  }
  return chunk;
}

Unpacked unpack_chunk(const BagFile& file, const Ros1Chunk& chunk) {
  std::string packed = file.read(chunk.data_begin, chunk.packed);
  if (chunk.compression == Ros1Compression::kNone) return {std::move(packed), ""};
  // What the whole chunk may unpack to was checked when its head was read; of a cut one less is
  // there, which the limit counts.
  const std::uint64_t most =
      chunk.cut ? std::min<std::uint64_t>(chunk.size, most_unpacked_size(packed.size()))
                : chunk.size;
  const std::string where = file.place(chunk.begin) + ": a chunk";
  return chunk.compression == Ros1Compression::kBz2 ? unpack_bz2(packed, most, where)
                                                    : unpack_lz4(packed, most, where);
}

std::optional<Ros1ChunkRecord> Ros1ChunkWalk::next() {
  problem_.clear();
  if (at_ >= bytes_.size()) return std::nullopt;
  try {
    return read_next();
  } catch (const UnreadableError&) {
    throw;
  } catch (const DataError& error) {
    problem_ = error.what();
    return std::nullopt;
  }
}

std::optional<Ros1ChunkRecord> Ros1ChunkWalk::read_next() {
  while (at_ < bytes_.size()) {
    Ros1ChunkRecord found;
    found.begin = at_;
    found.record = read_record(bytes_, at_);
    const std::string where = bytes_.place(at_);
    check_data_is_there(bytes_, found.record);
    found.op = op_of(found.record, where);
    if (found.op == Ros1Op::kMessage) {
      found.connection = u32_field(found.record.header, "conn", where);
      found.time = time_field(found.record.header, "time", where);
    }
    at_ = found.record.end();
    if (found.op == Ros1Op::kMessage || found.op == Ros1Op::kConnection) return found;
  }
  return std::nullopt;
}

}  // namespace raymoval
