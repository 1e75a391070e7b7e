// SPDX-License-Identifier: MIT
#include "datasets/bags/ros1/chunk.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
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
