// SPDX-License-Identifier: MIT
#include "benchmark/process/scan_spool.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/part_name.h"

namespace raymoval {

ScanSpool::ScanSpool(std::string what, const std::filesystem::path& beside, std::size_t scans)
    : what_(std::move(what)), path_(beside), pieces_(scans) {
  Part part = new_part_file(beside, 0600);
  if (!part.held.valid()) fail("cannot be made");
  file_ = std::move(part.held);
  ::unlink(part.place.c_str());  // It lives as long as it is open, however the program ends.
}

void ScanSpool::fail(const char* problem) const {
  throw DataError(path_.string() + ": the file for " + what_ + " beside it " + problem + " (" +
                  std::generic_category().message(errno) +
                  "). Nothing was changed; free space or choose another place for -o.");
}

void ScanSpool::put(std::size_t scan, const std::string& piece) {
  if (!write_at(file_.get(), piece, size_)) fail("cannot be written");
  pieces_[scan] = {size_, piece.size()};
  size_ += piece.size();
}

std::string ScanSpool::get(std::size_t scan) const {
  const Piece& piece = pieces_[scan];
  std::string bytes = read_at(file_.get(), piece.bytes, piece.offset);
  if (bytes.size() < piece.bytes) fail("cannot be read");
  return bytes;
}

}  // namespace raymoval
