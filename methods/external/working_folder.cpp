// SPDX-License-Identifier: MIT
#include "methods/external/working_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "core/error.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderPrefix = "raymoval-external-";

/// The lock is a file beside the folder, not in it, so that the program cannot touch it.
fs::path lock_of(const fs::path& folder) {
  return folder.string() + ".lock";
}

/// Opens a lock and takes it. @return -1 if it is not there or somebody has it
int take_lock(const fs::path& path, int flags) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0600);
  if (file < 0) return -1;
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  ::close(file);
  return -1;
}

/// Makes a lock that nobody sees before it is taken. @return -1 with the reason in errno
int make_lock(const fs::path& path) {
  const fs::path unseen = path.string() + ".new";
  const int file = take_lock(unseen, O_CREAT | O_EXCL);
  if (file < 0 || ::rename(unseen.c_str(), path.c_str()) == 0) return file;
  const int reason = errno;
  ::unlink(unseen.c_str());
  ::close(file);
  errno = reason;
  return -1;
}

void remove_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  // Last, so that a folder that could only be removed in part is found again.
  fs::remove(lock_of(folder), ignored);
}

/// Removes what killed processes left. Only what is ours by name, owner and a free lock.
void sweep(const fs::path& root) {
  std::error_code error;
  for (auto entry = fs::directory_iterator(root, error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path lock = entry->path();
    if (!lock.filename().string().starts_with(kFolderPrefix) || lock.extension() != ".lock")
      continue;
    struct stat status {};
    if (::lstat(lock.c_str(), &status) != 0 || status.st_uid != ::geteuid()) continue;
    const int file = take_lock(lock, 0);
    if (file < 0) continue;
    remove_folder(lock.parent_path() / lock.stem());
    ::close(file);
  }
}

fs::path temporary_root() {
  std::error_code error;
  const fs::path root = fs::temp_directory_path(error);
  if (!error) return root;
  throw DataError("there is no folder for temporary files (" + error.message() +
                  "); set TMPDIR to one that exists.");
}

}  // namespace

void remove_abandoned_working_folders() {
  std::error_code error;
  const fs::path root = fs::temp_directory_path(error);
  if (!error) sweep(root);
}

WorkingFolder::WorkingFolder() {
  const fs::path root = temporary_root();
  sweep(root);
  std::string name = (root / (std::string(kFolderPrefix) + "XXXXXX")).string();
  // The folder first: its random name is nobody else's from then on.
  if (::mkdtemp(name.data()) == nullptr) {
    throw DataError(root.string() + ": no working folder can be made there (" +
                    std::generic_category().message(errno) +
                    "); set TMPDIR to a folder with space.");
  }
  path_ = name;
  lock_ = make_lock(lock_of(path_));
  if (lock_ < 0) {
    const int reason = errno;
    remove_folder(path_);
    throw DataError(path_.string() + ".lock: cannot be made (" +
                    std::generic_category().message(reason) +
                    "); set TMPDIR to a folder with space.");
  }
}

WorkingFolder::~WorkingFolder() {
  std::error_code ignored;
  if (kept_) {
    fs::remove(lock_of(path_), ignored);
  } else {
    remove_folder(path_);
  }
  ::close(lock_);
}

}  // namespace raymoval
