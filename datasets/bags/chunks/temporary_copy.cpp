// SPDX-License-Identifier: MIT
#include "datasets/bags/chunks/temporary_copy.h"

#include <sys/statvfs.h>

#include <algorithm>

#include "core/files/file_writer.h"
#include "datasets/bags/chunks/zstandard.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// What is left free for others.
constexpr std::uint64_t kSpare = std::uint64_t{64} << 20;

/// How much may be written to `folder`.
std::uint64_t room_in(const fs::path& folder) {
  struct statvfs status {};
  if (::statvfs(folder.c_str(), &status) != 0) return 0;
  const std::uint64_t free = std::uint64_t{status.f_bavail} * status.f_frsize;
  return free - std::min(free, kSpare);
}

}  // namespace

fs::path without_zstd_ending(const fs::path& name) {
  const bool ends = name.extension() == ".zst" || name.extension() == ".zstd";
  return ends ? name.parent_path() / name.stem() : name;
}

TemporaryCopy::TemporaryCopy(const BagFile& packed)
    : path_(folder_.path() / without_zstd_ending(packed.path().filename())) {
  const std::uint64_t counted = std::min(packed.size(), std::uint64_t{1} << 50U);
  const std::uint64_t most = std::min(room_in(folder_.path()), 1000 * counted + (1U << 20U));
  FileWriter writer(path_);
  problem_ = unpack_zstd_file(packed, most, [&](std::string_view piece) { writer.append(piece); });
  writer.commit();
}

}  // namespace raymoval
