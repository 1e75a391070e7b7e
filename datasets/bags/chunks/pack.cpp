// SPDX-License-Identifier: MIT
#include "datasets/bags/chunks/pack.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <limits>
#include <memory>
#include <new>

#include "core/error.h"
#include "datasets/bags/chunks/bag_file.h"

namespace raymoval {

std::string pack_zstd(std::string_view bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // There is room for whatever it gives.
  packed.resize(size);
  return packed;
}

void pack_zstd_file(const std::filesystem::path& file, FileWriter& output) {
  const BagFile bytes(file);
  const auto free_stream = [](ZSTD_CStream* stream) { ZSTD_freeCStream(stream); };
  const std::unique_ptr<ZSTD_CStream, decltype(free_stream)> stream(ZSTD_createCStream());
  if (!stream) throw std::bad_alloc();
  ZSTD_CCtx_setPledgedSrcSize(stream.get(), bytes.size());
  std::string piece(ZSTD_CStreamOutSize(), '\0');
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  for (std::uint64_t at = 0, left = 1; left > 0; at += kPiece) {
    const std::string plain = bytes.read_up_to(at, kPiece);
    const bool is_last = at + kPiece >= bytes.size();
    ZSTD_inBuffer in{plain.data(), plain.size(), 0};
    do {
      ZSTD_outBuffer out{piece.data(), piece.size(), 0};
      const auto mode = is_last ? ZSTD_e_end : ZSTD_e_continue;
      left = ZSTD_compressStream2(stream.get(), &out, &in, mode);
      // It fails only if the file has another size by now.
      if (ZSTD_isError(left) != 0) throw DataError(file.string() + ": changes while it is packed.");
      output.append(std::string_view(piece).substr(0, out.pos));
    } while (is_last ? left > 0 : in.pos < in.size);
    if (!is_last) left = 1;
  }
}

std::string pack_lz4(std::string_view bytes) {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  // What ROS 1 reads and writes: its own decoder takes no other kind of frame.
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.blockSizeID = LZ4F_max1MB;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string packed(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
  const std::size_t size =
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), &preferences);
  if (LZ4F_isError(size) != 0) throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

std::string pack_bz2(std::string_view bytes) {
  // The library's own bound: 1 % more and 600 bytes.
  const std::size_t most = bytes.size() + bytes.size() / 100 + 600;
  if (most > std::numeric_limits<unsigned>::max()) {
    throw InternalError("more than 4 GiB are packed by bzip2 at once");
  }
  std::string packed(most, '\0');
  auto size = static_cast<unsigned>(most);
  // The library does not write where it reads. 9: blocks of 900 kB, as all recorders have them.
  const int answer = BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(bytes.data()),
                                              static_cast<unsigned>(bytes.size()), 9, 0, 0);
  if (answer != BZ_OK) throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

}  // namespace raymoval
