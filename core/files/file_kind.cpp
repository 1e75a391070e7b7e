// SPDX-License-Identifier: MIT
#include "core/files/file_kind.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include "core/error.h"

namespace raymoval {

namespace fs = std::filesystem;

namespace {

/// A path that leads nowhere because of a link is damaged and not absent.
void check_no_link_to_nothing(const fs::path& path) {
  for (fs::path at = without_slash(path); !at.empty(); at = at.parent_path()) {
    struct stat status {};
    if (::lstat(at.c_str(), &status) != 0) {
      if (!means_absent(errno)) throw_inaccessible(at, errno);
      if (at == at.parent_path()) return;
      continue;
    }
    if (!S_ISLNK(status.st_mode) || ::stat(at.c_str(), &status) == 0) return;
    if (!means_absent(errno)) throw_inaccessible(at, errno);
    std::error_code ignored;
    throw DataError(at.string() + ": is a link to " + fs::read_symlink(at, ignored).string() +
                    ", which is not there. Fetch the data (such as `git annex get` or `dvc pull`), "
                    "or remove the link.");
  }
}

const char* special_name(mode_t mode) {
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

}  // namespace

void throw_inaccessible(const fs::path& path, int reason) {
  throw UnreadableError(
      path.string() + ": cannot be accessed (" + std::generic_category().message(reason) +
      "). Check the rights of the folders above it, and that its disk or share is reachable.");
}

bool means_absent(int reason) {
  return reason == ENOENT || reason == ENOTDIR;
}

FileKind file_kind(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (!means_absent(errno)) throw_inaccessible(path, errno);
    check_no_link_to_nothing(path);
    return FileKind::kAbsent;
  }
  if (S_ISREG(status.st_mode)) return FileKind::kFile;
  if (S_ISDIR(status.st_mode)) return FileKind::kFolder;
  throw DataError(path.string() + ": is " + special_name(status.st_mode) +
                  ", expected a plain file or a folder. Copy its content to a file and name that.");
}

bool is_file(const fs::path& path) {
  return file_kind(path) == FileKind::kFile;
}

bool is_folder(const fs::path& path) {
  return file_kind(path) == FileKind::kFolder;
}

bool is_there(const fs::path& path) {
  return file_kind(path) != FileKind::kAbsent;
}

bool has_file(const fs::path& path) {
  const FileKind kind = file_kind(path);
  if (kind != FileKind::kFolder) return kind == FileKind::kFile;
  throw DataError(path.string() + ": is a folder, expected a file. Move it away or rename it.");
}

bool has_folder(const fs::path& path) {
  const FileKind kind = file_kind(path);
  if (kind != FileKind::kFile) return kind == FileKind::kFolder;
  throw DataError(path.string() + ": is a file, expected a folder. Move it away or rename it.");
}

std::uintmax_t plain_file_size(const fs::path& path) {
  if (!has_file(path)) throw DataError(path.string() + ": there is no such file.");
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw_inaccessible(path, error.value());
  return size;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  // The forms that take an error_code end the program if they have no memory.
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      entries.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    throw UnreadableError(folder.string() + ": cannot be listed (" + error.code().message() + ").");
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const fs::path& entry : entries_of(folder)) {
    struct stat status {};
    if (::stat(entry.c_str(), &status) != 0) {
      if (!means_absent(errno)) throw_inaccessible(entry, errno);
    } else if (S_ISDIR(status.st_mode)) {
      folders.push_back(entry);
    }
  }
  return folders;
}

fs::path without_slash(const fs::path& path) {
  return path.has_filename() || !path.has_relative_path() ? path : path.parent_path();
}

fs::path folder_of(const fs::path& path) {
  const fs::path named = without_slash(path);
  return named.has_parent_path() ? named.parent_path() : fs::path(".");
}

void remove_if_there(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (!error) return;
  throw DataError(path.string() + ": cannot be removed (" + error.message() +
                  "). Remove it yourself, or choose another place.");
}

bool is_link(const fs::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) return S_ISLNK(status.st_mode);
  if (!means_absent(errno)) throw_inaccessible(path, errno);
  return false;
}

std::optional<std::pair<dev_t, ino_t>> identity_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return std::pair{status.st_dev, status.st_ino};
  if (!means_absent(errno)) throw_inaccessible(path, errno);
  return std::nullopt;
}

}  // namespace raymoval
