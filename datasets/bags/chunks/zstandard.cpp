// SPDX-License-Identifier: MIT
#include "datasets/bags/chunks/zstandard.h"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Unpacks what it is given, piece by piece.
class Unpacker {
 public:
  using Take = std::function<void(std::string_view)>;

  Unpacker() : stream_(ZSTD_createDStream()), piece_(ZSTD_DStreamOutSize(), '\0') {
    if (!stream_) throw std::bad_alloc();
  }

  /// Unpacks `packed` up to `most` bytes in all, and no further.
  /// @return what is wrong with it; empty if nothing is so far
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
  bool ended_ = false;  ///< Whether what came so far ends with the end of a frame.
};

}  // namespace

bool is_zstd(std::string_view bytes) {
  return bytes.starts_with("\x28\xB5\x2F\xFD");
}

Unpacked unpack_zstd(std::string_view packed, std::uint64_t stated, const std::string& where) {
  check_unpacked_size(packed.size(), stated, where);
  Unpacked unpacked;
  unpacked.bytes.reserve(stated);
  Unpacker unpacker;
  unpacked.problem =
      unpacker.add(packed, stated, [&](std::string_view piece) { unpacked.bytes += piece; });
  if (unpacker.made() > stated) {
    unpacked.problem =
        "it unpacks to more than the " + grouped_text(stated) + " bytes that it is said to have";
  }
  if (unpacked.problem.empty()) unpacked.problem = unpacker.end();
  if (unpacked.problem.empty() && unpacker.made() < stated) {
    unpacked.problem = "it unpacks to " + grouped_text(unpacker.made()) + " of the " +
                       grouped_text(stated) + " bytes that it is said to have";
  }
  return unpacked;
}

std::string unpack_zstd_message(std::string_view packed, const std::string& where) {
  const unsigned long long said = ZSTD_getFrameContentSize(packed.data(), packed.size());
  const std::uint64_t most = most_unpacked_size(packed.size());
  if (said < ZSTD_CONTENTSIZE_ERROR) check_unpacked_size(packed.size(), said, where);
  std::string bytes;
  if (said < ZSTD_CONTENTSIZE_ERROR) bytes.reserve(said);
  Unpacker unpacker;
  std::string problem = unpacker.add(packed, most, [&](std::string_view piece) { bytes += piece; });
  if (unpacker.made() > most) {
    problem = "it unpacks to more than " + grouped_text(most) +
              " bytes, the limit of 1 GiB and of 1,000 times its bytes and 1 MiB";
  }
  if (problem.empty()) problem = unpacker.end();
  if (problem.empty()) return bytes;
  throw DataError(where + ": " + problem + ". Copy the file again.");
}

std::string unpacked_if_packed(std::string message, bool is_cdr, const std::string& where) {
  return is_cdr && is_zstd(message) ? unpack_zstd_message(message, where) : std::move(message);
}

std::string unpack_zstd_file(const BagFile& file, std::uint64_t most,
                             const std::function<void(std::string_view)>& take) {
  Unpacker unpacker;
  std::string problem;
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  for (std::uint64_t at = 0; at < file.size() && problem.empty(); at += kPiece) {
    problem = unpacker.add(file.read_up_to(at, kPiece), most, take);
    if (unpacker.made() <= most) continue;
    throw DataError(file.path().string() + ": unpacks to more than " + grouped_text(most) +
                    " bytes, which is more than is expected of a recording of " +
                    grouped_text(file.size()) +
                    " bytes or than the disk has room for. Unpack it by `zstd --decompress` to "
                    "where there is room, and name that.");
  }
  return problem.empty() ? unpacker.end() : problem;
}

}  // namespace raymoval
