// SPDX-License-Identifier: MIT
#include "core/files/file_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/part_name.h"

namespace raymoval {

FileWriter::FileWriter(std::filesystem::path path)
    : path_(std::move(path)),
      temporary_(new_part_name(path_)),
      file_(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644)) {
  if (!file_.valid()) fail();
}

FileWriter::~FileWriter() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void FileWriter::fail() const {
  throw DataError(path_.string() + ": cannot be written (" +
                  std::generic_category().message(errno) +
                  "). Nothing was changed; free space or choose another place.");
}

void FileWriter::put(std::string_view content, std::uint64_t offset) {
  synced_ = false;
  if (!write_at(file_.get(), content, offset)) fail();
}

void FileWriter::append(std::string_view content) {
  put(content, size_);
  size_ += content.size();
}

void FileWriter::overwrite(std::uint64_t offset, std::string_view content) {
  if (offset + content.size() > size_) {
    throw InternalError(path_.string() + ": overwrites what was not written");
  }
  put(content, offset);
}

void FileWriter::sync() {
  if (!synced_ && ::fsync(file_.get()) != 0) fail();
  synced_ = true;
}

void FileWriter::commit() {
  sync();
  if (!file_.close()) fail();
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  committed_ = true;
  sync_folder(path_.has_parent_path() ? path_.parent_path() : std::filesystem::path("."));
}

void sync_folder(const std::filesystem::path& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.valid()) ::fsync(opened.get());  // A file system that cannot do this has its own ways.
}

}  // namespace raymoval
