// SPDX-License-Identifier: MIT
#include "core/files/descriptor_io.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/error.h"

namespace raymoval {

bool write_at(int file, std::string_view content, std::uint64_t offset) {
  while (!content.empty()) {
    const ssize_t put = ::pwrite(file, content.data(), content.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put == 0) errno = ENOSPC;
    if (put <= 0) return false;
    content.remove_prefix(static_cast<std::size_t>(put));
    offset += static_cast<std::uint64_t>(put);
  }
  return true;
}

std::optional<std::size_t> read_at(int file, void* data, std::size_t size, std::uint64_t offset) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::pread(file, static_cast<char*>(data) + done, size - done,
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return std::nullopt;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string read_at(int file, std::size_t size, std::uint64_t offset) {
  std::string content(size, '\0');
  content.resize(read_at(file, content.data(), size, offset).value_or(0));
  return content;
}

Descriptor memory_file(const char* name) {
  Descriptor file(::memfd_create(name, MFD_CLOEXEC));
  if (file.valid()) return file;
  throw DataError(fmt::format("the system has no memory for a file '{}' ({}).", name,
                              std::generic_category().message(errno)));
}

}  // namespace raymoval
