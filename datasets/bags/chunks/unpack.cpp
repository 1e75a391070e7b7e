// SPDX-License-Identifier: MIT
#include "datasets/bags/chunks/unpack.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <new>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr std::uint64_t kMostUnpacked = std::uint64_t{1} << 30;
constexpr std::uint64_t kMostGain = 1000;
constexpr std::uint64_t kFreeGain = std::uint64_t{1} << 20;

std::string too_much(std::uint64_t stated) {
  return "it unpacks to more than the " + grouped_text(stated) + " bytes that it is said to have";
}

std::string too_little(std::uint64_t got, std::uint64_t stated) {
  return "it unpacks to " + grouped_text(got) + " of the " + grouped_text(stated) +
         " bytes that it is said to have";
}

/// What a bzip2 stream is at.
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

/// Room for what is unpacked: all that is stated and one byte, which tells what has more. It grows
/// with what comes, so that a head that lies asks for no memory.
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

Unpacked result(Room& room, std::uint64_t stated, std::string problem) {
  if (room.over()) problem = too_much(stated);
  if (problem.empty() && room.used() < stated) problem = too_little(room.used(), stated);
  return {room.take(), std::move(problem)};
}

}  // namespace

std::uint64_t most_unpacked_size(std::uint64_t packed) {
  const std::uint64_t counted = std::min(packed, kMostUnpacked);
  return std::min(kMostUnpacked, kMostGain * counted + kFreeGain);
}

void check_unpacked_size(std::uint64_t packed, std::uint64_t unpacked, const std::string& where) {
  if (unpacked <= most_unpacked_size(packed)) return;
  throw DataError(where + " of " + grouped_text(packed) + " bytes is said to unpack to " +
                  grouped_text(unpacked) +
                  ", beyond the limit of 1 GiB and of 1,000 times its bytes and 1 MiB; the file "
                  "looks damaged. Copy it again.");
}

Unpacked unpack_bz2(std::string_view packed, std::uint64_t stated, const std::string& where) {
  check_unpacked_size(packed.size(), stated, where);
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

Unpacked unpack_lz4(std::string_view packed, std::uint64_t stated, const std::string& where) {
  check_unpacked_size(packed.size(), stated, where);
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

}  // namespace raymoval
