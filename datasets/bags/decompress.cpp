// SPDX-License-Identifier: MIT
#include "datasets/bags/decompress.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <new>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr std::uint64_t kMostDecompressed = std::uint64_t{1} << 30;
constexpr std::uint64_t kMostGain = 1000;
constexpr std::uint64_t kFreeGain = std::uint64_t{1} << 20;

std::string too_much(std::uint64_t stated) {
  return "it decompresses to more than the " + grouped_text(stated) + " bytes that it should have";
}

std::string too_little(std::uint64_t got, std::uint64_t stated) {
  return "it decompresses to " + grouped_text(got) + " of the " + grouped_text(stated) +
         " bytes that it should have";
}

/// The state of a bzip2 stream.
class Bz2Stream {
 public:
  Bz2Stream() { start(); }
  ~Bz2Stream() { BZ2_bzDecompressEnd(&stream_); }
  Bz2Stream(const Bz2Stream&) = delete;
  Bz2Stream& operator=(const Bz2Stream&) = delete;
  void start_again() {
    BZ2_bzDecompressEnd(&stream_);
    start();
  }
  bz_stream& operator*() { return stream_; }

 private:
  void start() {
    stream_ = {};
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  bz_stream stream_{};
};

/// A buffer of the stated size and one byte, which detects further data. It grows with the data, so
/// that a wrong size in a header allocates no memory.
class Room {
 public:
  explicit Room(std::uint64_t stated) : most_(static_cast<std::size_t>(stated) + 1) {}
  [[nodiscard]] bool over() const { return used_ >= most_; }
  char* free_begin() {
    if (used_ == bytes_.size()) {
      bytes_.resize(std::min(most_, std::max<std::size_t>(2 * bytes_.size(), kFirst)));
    }
    return bytes_.data() + used_;
  }
  [[nodiscard]] std::size_t free_size() const { return bytes_.size() - used_; }
  void use(std::size_t count) { used_ += count; }
  [[nodiscard]] std::size_t used() const { return used_; }
  std::string take() {
    bytes_.resize(std::min(used_, most_ - 1));
    return std::move(bytes_);
  }

 private:
  static constexpr std::size_t kFirst = std::size_t{1} << 20;
  std::size_t most_, used_ = 0;
  std::string bytes_;
};

Decompressed result(Room& room, std::uint64_t stated, std::string problem) {
  if (room.over()) problem = too_much(stated);
  if (problem.empty() && room.used() < stated) problem = too_little(room.used(), stated);
  return {room.take(), std::move(problem)};
}

}  // namespace

std::uint64_t most_decompressed_size(std::uint64_t packed) {
  const std::uint64_t counted = std::min(packed, kMostDecompressed);
  return std::min(kMostDecompressed, kMostGain * counted + kFreeGain);
}

void check_decompressed_size(std::uint64_t packed, std::uint64_t unpacked,
                             const std::string& where) {
  if (unpacked <= most_decompressed_size(packed)) return;
  throw DataError(where + " of " + grouped_text(packed) + " bytes should decompress to " +
                  grouped_text(unpacked) +
                  ", beyond the limit of 1 GiB and of 1,000 times its bytes and 1 MiB; the file "
                  "looks damaged. Copy it again.");
}

Decompressed decompress_bz2(std::string_view packed, std::uint64_t stated,
                            const std::string& where) {
  check_decompressed_size(packed.size(), stated, where);
  Bz2Stream stream;
  Room room(stated);
  constexpr std::size_t kPiece = std::numeric_limits<unsigned>::max();
  while (!room.over()) {
    bz_stream& state = *stream;
    const auto given = static_cast<unsigned>(std::min(packed.size(), kPiece));
    state.next_in = const_cast<char*>(packed.data());  // The library does not write there.
    state.avail_in = given;
    state.next_out = room.free_begin();
    const auto free = static_cast<unsigned>(std::min(room.free_size(), kPiece));
    state.avail_out = free;
    const int answer = BZ2_bzDecompress(&state);
    const std::size_t taken = given - state.avail_in, made = free - state.avail_out;
    packed.remove_prefix(taken);
    room.use(made);
    if (answer == BZ_MEM_ERROR) throw std::bad_alloc();
    if (answer == BZ_STREAM_END) {
      if (packed.empty()) return result(room, stated, "");
      stream.start_again();
    } else if (answer != BZ_OK) {
      return result(room, stated, "the bzip2 data is damaged");
    } else if (taken == 0 && made == 0) {
      return result(room, stated, "the bzip2 data ends early");
    }
  }
  return result(room, stated, "");
}

Decompressed decompress_lz4(std::string_view packed, std::uint64_t stated,
                            const std::string& where) {
  check_decompressed_size(packed.size(), stated, where);
  LZ4F_dctx* made_context = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made_context, LZ4F_VERSION)) != 0) {
    throw std::bad_alloc();
  }
  const auto free_context = [](LZ4F_dctx* context) { LZ4F_freeDecompressionContext(context); };
  const std::unique_ptr<LZ4F_dctx, decltype(free_context)> context(made_context, free_context);
  Room room(stated);
  while (!room.over()) {
    char* to = room.free_begin();
    std::size_t made = room.free_size(), taken = packed.size();
    const std::size_t left =
        LZ4F_decompress(context.get(), to, &made, packed.data(), &taken, nullptr);
    if (LZ4F_isError(left) != 0) {
      return result(room, stated,
                    std::string("the lz4 data is damaged (") + LZ4F_getErrorName(left) + ")");
    }
    packed.remove_prefix(taken);
    room.use(made);
    if (left == 0 && packed.empty()) return result(room, stated, "");
    if (taken == 0 && made == 0) return result(room, stated, "the lz4 data ends early");
  }
  return result(room, stated, "");
}

namespace {

/// Decompresses piece by piece.
class Decompressor {
 public:
  using Take = std::function<void(std::string_view)>;

  Decompressor() : stream_(ZSTD_createDStream()), piece_(ZSTD_DStreamOutSize(), '\0') {
    if (!stream_) throw std::bad_alloc();
  }

  /// Decompresses `packed` up to `most` bytes in all.
  /// @return the problem; empty if there is none yet
  std::string add(std::string_view packed, std::uint64_t most, const Take& take) {
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    for (bool full = false; (in.pos < in.size || full) && made_ <= most;) {
      ZSTD_outBuffer out{piece_.data(), piece_.size(), 0};
      const std::size_t left = ZSTD_decompressStream(stream_.get(), &out, &in);
      if (ZSTD_isError(left) != 0) {
        return std::string("the zstd data is damaged (") + ZSTD_getErrorName(left) + ")";
      }
      const std::uint64_t room = most - made_;
      made_ += out.pos;
      take({piece_.data(), static_cast<std::size_t>(std::min<std::uint64_t>(out.pos, room))});
      full = out.pos == out.size;
      ended_ = left == 0;
    }
    return {};
  }
  [[nodiscard]] std::string end() const { return ended_ ? "" : "the zstd data ends early"; }
  [[nodiscard]] std::uint64_t made() const { return made_; }

 private:
  struct Free {
    void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
  };
  std::unique_ptr<ZSTD_DStream, Free> stream_;
  std::string piece_;
  std::uint64_t made_ = 0;
  bool ended_ = false;  ///< Whether the input ends with the end of a frame.
};

}  // namespace

bool is_zstd(std::string_view bytes) {
  return bytes.starts_with("\x28\xB5\x2F\xFD");
}

Decompressed decompress_zstd(std::string_view packed, std::uint64_t stated,
                             const std::string& where) {
  check_decompressed_size(packed.size(), stated, where);
  Decompressed unpacked;
  unpacked.bytes.reserve(stated);
  Decompressor unpacker;
  unpacked.problem =
      unpacker.add(packed, stated, [&](std::string_view piece) { unpacked.bytes += piece; });
  if (unpacker.made() > stated) unpacked.problem = too_much(stated);
  if (unpacked.problem.empty()) unpacked.problem = unpacker.end();
  if (unpacked.problem.empty() && unpacker.made() < stated) {
    unpacked.problem = too_little(unpacker.made(), stated);
  }
  return unpacked;
}

std::string decompress_zstd_message(std::string_view packed, const std::string& where) {
  const unsigned long long said = ZSTD_getFrameContentSize(packed.data(), packed.size());
  const std::uint64_t most = most_decompressed_size(packed.size());
  if (said < ZSTD_CONTENTSIZE_ERROR) check_decompressed_size(packed.size(), said, where);
  std::string bytes;
  if (said < ZSTD_CONTENTSIZE_ERROR) bytes.reserve(said);
  Decompressor unpacker;
  std::string problem = unpacker.add(packed, most, [&](std::string_view piece) { bytes += piece; });
  if (unpacker.made() > most) {
    problem = "it decompresses to more than " + grouped_text(most) +
              " bytes, the limit of 1 GiB and of 1,000 times its bytes and 1 MiB";
  }
  if (problem.empty()) problem = unpacker.end();
  if (problem.empty()) return bytes;
  throw DataError(where + ": " + problem + ". Copy the file again.");
}

std::string decompressed_if_needed(std::string message, bool is_cdr, const std::string& where) {
  return is_cdr && is_zstd(message) ? decompress_zstd_message(message, where) : std::move(message);
}

std::string decompress_zstd_file(const BagFile& file, std::uint64_t most,
                                 const std::function<void(std::string_view)>& take) {
  Decompressor unpacker;
  std::string problem;
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  for (std::uint64_t at = 0; at < file.size() && problem.empty(); at += kPiece) {
    problem = unpacker.add(file.read_up_to(at, kPiece), most, take);
    if (unpacker.made() <= most) continue;
    throw DataError(file.path().string() + ": decompresses to more than " + grouped_text(most) +
                    " bytes, which is more than is expected of a recording of " +
                    grouped_text(file.size()) +
                    " bytes or than the disk has room for. Decompress it by `zstd --decompress` on "
                    "a disk with room, and name that file.");
  }
  return problem.empty() ? unpacker.end() : problem;
}

namespace {

/// Chunks that are still being decompressed count as 0 bytes, so the number is limited, too.
constexpr std::size_t kMostChunks = 64;

}  // namespace

std::shared_ptr<ChunkStore::Slot> ChunkStore::slot_of(std::uint64_t number) {
  const std::scoped_lock lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const Kept& kept) { return kept.number == number; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
  } else {
    kept_.push_front({number, std::make_shared<Slot>(), 0});
    if (kept_.size() > kMostChunks) kept_.pop_back();
  }
  return kept_.front().slot;
}

void ChunkStore::note_size(std::uint64_t number, std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  std::size_t total = 0;
  for (auto kept = kept_.begin(); kept != kept_.end();) {
    if (kept->number == number) kept->bytes = bytes;
    total += kept->bytes;
    const bool drop = total > most_bytes_ && kept != kept_.begin() && kept->bytes > 0;
    if (drop) total -= kept->bytes;
    kept = drop ? kept_.erase(kept) : std::next(kept);
  }
}

ChunkStore::Chunk ChunkStore::get(std::uint64_t number, const Unpack& unpack) {
  const std::shared_ptr<Slot> slot = slot_of(number);
  const std::scoped_lock unpacking(slot->unpacking);
  if (!slot->chunk) {
    slot->chunk = std::make_shared<const std::string>(unpack());
    note_size(number, slot->chunk->size());
  }
  return slot->chunk;
}

std::filesystem::path without_zstd_ending(const std::filesystem::path& name) {
  const bool ends = name.extension() == ".zst" || name.extension() == ".zstd";
  return ends ? name.parent_path() / name.stem() : name;
}

}  // namespace raymoval
