// SPDX-License-Identifier: MIT
#include "datasets/bags/bag_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/files/descriptor_io.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

[[noreturn]] void throw_unreadable(const std::filesystem::path& path, int reason) {
  throw UnreadableError(path.string() + ": cannot be read (" +
                        std::generic_category().message(reason) +
                        "). Check its rights, and that its disk or share is reachable.");
}

}  // namespace

BagFile::BagFile(std::filesystem::path path) : path_(std::move(path)) {
  size_ = plain_file_size(path_);
  file_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file_.valid()) throw_unreadable(path_, errno);
}

std::string BagFile::place(std::uint64_t offset) const {
  return path_.filename().string() + ": byte " + grouped_text(offset);
}

std::string BagFile::read_up_to(std::uint64_t offset, std::uint64_t size) const {
  if (offset >= size_) return {};
  std::string bytes(std::min(size, size_ - offset), '\0');
  const auto got = read_at(file_.get(), bytes.data(), bytes.size(), offset);
  if (!got) throw_unreadable(path_, errno);
  bytes.resize(*got);
  return bytes;
}

std::string BagFile::read(std::uint64_t offset, std::uint64_t size) const {
  std::string bytes;
  if (offset <= size_ && size <= size_ - offset) bytes = read_up_to(offset, size);
  if (bytes.size() == size) return bytes;
  throw DataError(place(offset) + ": " + grouped_text(size) +
                  " bytes should follow, but the file " + "has " + grouped_text(size_) +
                  " bytes; it is truncated or damaged. Copy it again.");
}

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace raymoval
