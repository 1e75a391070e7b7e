// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <new>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {
namespace {

/// Limit of the decompressed size. Deflate cannot give more than 1,032 times its bytes.
std::uint64_t most_decompressed(std::uint64_t packed) {
  return std::min<std::uint64_t>(std::uint64_t{1} << 30, packed * 1000 + (1 << 20));
}

class Inflation {
 public:
  Inflation(std::string_view packed, const std::string& where) : where_(where), packed_(packed) {
    constexpr int kGzip = 15 + 16;
    if (::inflateInit2(&stream_, kGzip) != Z_OK) throw std::bad_alloc();
  }
  ~Inflation() { ::inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;

  /// Decompresses up to the end of a stream and appends the result to `text`.
  /// @return false if there is more than `most` in all
  bool decompress_into(std::string& text, std::uint64_t most) {
    for (int state = Z_OK; state != Z_STREAM_END;) {
      if (filled_ > most) return false;
      if (filled_ == text.size()) grow(text, most);
      // zlib counts with 32 bits.
      constexpr std::size_t kAtOnce = std::size_t{1} << 30;
      const auto in = static_cast<uInt>(std::min(packed_.size() - used_, kAtOnce));
      const auto out = static_cast<uInt>(std::min(text.size() - filled_, kAtOnce));
      stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed_.data() + used_));
      stream_.avail_in = in;
      stream_.next_out = reinterpret_cast<Bytef*>(text.data() + filled_);
      stream_.avail_out = out;
      state = ::inflate(&stream_, Z_NO_FLUSH);
      used_ += in - stream_.avail_in;
      filled_ += out - stream_.avail_out;
      check(state, stream_.avail_out);
    }
    return filled_ <= most;
  }
  void begin_again() { ::inflateReset(&stream_); }
  [[nodiscard]] std::string_view rest() const { return packed_.substr(used_); }
  [[nodiscard]] std::size_t filled() const { return filled_; }

 private:
  static void grow(std::string& text, std::uint64_t most) {
    // One byte more than the limit shows that there is more.
    text.resize(std::min<std::uint64_t>(most + 1, std::max<std::size_t>(4096, 2 * text.size())));
  }
  void check(int state, uInt room) const {
    if (state == Z_STREAM_END || state == Z_OK) return;
    if (state == Z_BUF_ERROR && room == 0) return;
    if (state == Z_MEM_ERROR) throw std::bad_alloc();
    if (state == Z_BUF_ERROR) {
      throw DataError(where_ + ": the compressed data ends after " + grouped_text(packed_.size()) +
                      " bytes, in the middle; the file looks truncated." + kRereadRemedy);
    }
    throw DataError(where_ + ": the compressed data is damaged near byte " + grouped_text(used_) +
                    (stream_.msg != nullptr ? " (" + std::string(stream_.msg) + ")" : "") +
                    ". Copy the file again.");
  }

  const std::string& where_;
  std::string_view packed_;
  z_stream stream_{};
  std::size_t used_ = 0, filled_ = 0;
};

}  // namespace

void check_decompressed(std::uint64_t packed, std::uint64_t unpacked, const std::string& where) {
  if (unpacked <= most_decompressed(packed)) return;
  throw DataError(where + ": decompresses to more than " + grouped_text(most_decompressed(packed)) +
                  " bytes, the limit for " + grouped_text(packed) +
                  " compressed ones (1,000 times as many and 1 MiB, at most 1 GiB). Decompress it "
                  "yourself if you trust it.");
}

std::string decompress_gzip(std::string_view packed, const std::string& where) {
  const std::uint64_t most = most_decompressed(packed.size());
  std::string text;
  Inflation inflation(packed, where);
  for (;;) {
    if (!inflation.decompress_into(text, most)) check_decompressed(packed.size(), most + 1, where);
    const std::string_view rest = inflation.rest();
    if (rest.find_first_not_of('\0') == std::string_view::npos) break;
    if (!rest.starts_with("\x1F\x8B")) {
      throw DataError(where + ": " + grouped_text(rest.size()) +
                      " bytes follow the end of the compressed data that are not gzip; the file is "
                      "damaged. Copy it again.");
    }
    inflation.begin_again();
  }
  text.resize(inflation.filled());
  return text;
}

}  // namespace raymoval
