// SPDX-License-Identifier: MIT
#include "core/scan/scan_spool.h"

#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/part_name.h"

namespace raymoval {

struct ScanSpool::File {
  std::filesystem::path beside;
  std::string what;
  Descriptor content;
  std::mutex mutex;
  std::uint64_t size = 0;

  [[noreturn]] void fail(const char* problem) const {
    throw DataError(beside.string() + ": the file for " + what + " beside it " + problem + " (" +
                    std::generic_category().message(errno) +
                    "). Nothing was changed; free space or choose another place.");
  }
};

ScanSpool::ScanSpool(std::size_t scans, const std::filesystem::path& beside,
                     const std::string& what)
    : file_(std::make_shared<File>()), pieces_(scans) {
  file_->beside = beside;
  file_->what = what;
  Part part = new_part_file(beside, 0600);
  if (!part.held.valid()) file_->fail("cannot be made");
  file_->content = std::move(part.held);
  ::unlink(part.place.c_str());  // The file exists until it is closed.
}

void ScanSpool::put(std::size_t scan, std::string piece) {
  const std::size_t size = piece.size();
  if (file_ == nullptr) {
    pieces_[scan] = {std::move(piece), 0, size, true};
    return;
  }
  const std::lock_guard lock(file_->mutex);
  if (!write_at(file_->content.get(), piece, file_->size)) file_->fail("cannot be written");
  pieces_[scan] = {{}, file_->size, size, true};
  file_->size += size;
}

void ScanSpool::append(std::string piece) {
  pieces_.emplace_back();
  put(pieces_.size() - 1, std::move(piece));
}

std::string ScanSpool::get(std::size_t scan) const {
  const Piece& piece = pieces_[scan];
  if (file_ == nullptr) return piece.bytes;
  std::string bytes = read_at(file_->content.get(), piece.size, piece.offset);
  if (bytes.size() < piece.size) file_->fail("cannot be read");
  return bytes;
}

std::size_t ScanSpool::bytes() const {
  std::size_t bytes = pieces_.size() * sizeof(Piece);
  for (const Piece& piece : pieces_) bytes += piece.bytes.size();
  return bytes;
}

}  // namespace raymoval
