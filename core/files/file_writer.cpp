// SPDX-License-Identifier: MIT
#include "core/files/file_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/file_kind.h"
#include "core/files/replacements.h"

namespace raymoval {
namespace {

std::string reason_text(int reason) {
  return std::generic_category().message(reason);
}

/// Gives a file the owner and the rights of the file that it replaces, as far as the system allows
/// that. It was made for its owner alone, so that no other user gets more rights.
void keep_owner_and_rights(int file, const struct stat& before) {
  // The owner first, because that may take rights away.
  const bool owner = ::fchown(file, before.st_uid, before.st_gid) == 0;
  const bool group = owner || ::fchown(file, static_cast<uid_t>(-1), before.st_gid) == 0;
  mode_t rights = before.st_mode & 0777U;
  // Rights of the old group are not given to another group.
  if (!group) rights &= ~070U | (rights & 07U) << 3U;
  [[maybe_unused]] const int kept = ::fchmod(file, rights);  // Some file systems have no rights.
}

/// A new part of `target` with its owner and rights, if it is a file.
Part part_like(const std::filesystem::path& target) {
  struct stat before {};
  const bool is_there = ::lstat(target.c_str(), &before) == 0;
  if (!is_there && !means_absent(errno)) return {};
  const bool replaces = is_there && S_ISREG(before.st_mode);
  Part part = new_part_file(target, replaces ? 0600 : 0666);
  if (part.held.valid() && replaces) keep_owner_and_rights(part.held.get(), before);
  return part;
}

/// Not valid if the folder may not be read; files in it may still be writable.
Descriptor opened_folder(const std::filesystem::path& folder) {
  Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.valid() || errno == EACCES) return opened;
  throw DataError(folder.string() + ": cannot be opened (" + reason_text(errno) +
                  "), so files in it cannot be synchronised to the disk.");
}

void sync_names(const Descriptor& opened, const std::filesystem::path& folder) {
  if (!opened.valid() || ::fsync(opened.get()) == 0) return;
  // A file system without this operation manages rights itself.
  if (errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return;
  throw DataError(folder.string() + ": it cannot be synchronised to the disk (" +
                  reason_text(errno) +
                  "). New files in it may be lost if the machine stops. Check the disk.");
}

}  // namespace

FileWriter::FileWriter(std::filesystem::path path)
    : path_(std::move(path)), part_(part_like(path_)) {
  if (!part_.held.valid()) fail();
}

FileWriter::~FileWriter() {
  if (!committed_) ::unlink(part_.place.c_str());
}

void FileWriter::fail() const {
  throw DataError(path_.string() + ": cannot be written (" + reason_text(errno) +
                  "). The file is as it was; free space or choose another place.");
}

void FileWriter::put(std::string_view content, std::uint64_t offset) {
  synced_ = false;
  if (!write_at(part_.held.get(), content, offset)) fail();
}

void FileWriter::append(std::string_view content) {
  put(content, size_);
  size_ += content.size();
}

void FileWriter::overwrite(std::uint64_t offset, std::string_view content) {
  if (offset + content.size() > size_) {
    throw InternalError(path_.string() + ": overwrites bytes that were not written");
  }
  put(content, offset);
}

void FileWriter::sync() {
  if (!synced_ && ::fsync(part_.held.get()) != 0) fail();
  synced_ = true;
}

void FileWriter::commit() {
  sync();
  const std::filesystem::path folder = folder_of(path_);
  const Descriptor opened = opened_folder(folder);
  if (::rename(part_.place.c_str(), path_.c_str()) != 0) fail();
  committed_ = true;
  part_.held.close();  // Its lock was needed as long as it had the name of a part.
  sync_names(opened, folder);
}

void FileWriter::commit_with(Replacements& together) {
  sync();
  together.add(std::move(part_), path_);
  committed_ = true;
}

std::filesystem::path output_target(const std::filesystem::path& named) {
  if (!is_link(named)) return named;
  const std::string where = named.string() + ": is a link to ";
  std::error_code error;
  std::filesystem::path target = std::filesystem::canonical(named, error);
  if (error) {
    std::error_code ignored;
    throw DataError(where + std::filesystem::read_symlink(named, ignored).string() +
                    ", where nothing can be written (" + error.message() +
                    "). Remove the link, or name another file.");
  }
  if (is_file(target)) return target;
  throw DataError(where + target.string() + ", which is not a file. Name another file.");
}

void sync_folder(const std::filesystem::path& folder) {
  sync_names(opened_folder(folder), folder);
}

std::error_code make_folders(const std::filesystem::path& folder) {
  using std::filesystem::file_type;
  std::error_code error;
  const file_type type = std::filesystem::status(folder, error).type();
  if (type == file_type::directory) return {};
  if (type == file_type::none) return error;
  if (type != file_type::not_found) return std::make_error_code(std::errc::not_a_directory);
  const std::filesystem::path place = without_slash(folder), above = folder_of(place);
  if (above != place) {
    error = make_folders(above);
    if (error) return error;
  }
  // It may be there by now: another process made it, which puts its name on the disk.
  if (std::filesystem::create_directory(place, error)) sync_folder(above);
  return error;
}

}  // namespace raymoval
