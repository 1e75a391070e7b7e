// SPDX-License-Identifier: MIT
#include "methods/external/working_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "core/error.h"
#include "methods/external/external.h"

namespace raymoval {
namespace external_method {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderPrefix = "raymoval-external-";

[[noreturn]] void throw_no_space(const std::string& what, int reason) {
  throw DataError(fmt::format("{} ({}); set TMPDIR to a folder with space.", what,
                              std::generic_category().message(reason)));
}

/// The lock is a file beside the folder, not in it, so that the program cannot touch it.
fs::path lock_of(const fs::path& folder) {
  return folder.string() + ".lock";
}

/// Opens a lock and takes it. The lock is not valid if it is not there or somebody has it.
Descriptor take_lock(const fs::path& path, int flags) {
  Descriptor lock(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | flags, 0600));
  if (lock.valid() && ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) lock.close();
  return lock;
}

/// Makes a lock that nobody sees before it is taken. @throws DataError with the system's reason
Descriptor make_lock(const fs::path& path) {
  const fs::path unseen = path.string() + ".new";
  Descriptor lock = take_lock(unseen, O_CREAT | O_EXCL);
  if (lock.valid() && ::rename(unseen.c_str(), path.c_str()) == 0) return lock;
  const int reason = errno;
  if (lock.valid()) ::unlink(unseen.c_str());
  throw_no_space(path.string() + ": cannot be made", reason);
}

void remove_folder(const fs::path& folder) {
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  // Last, so that a folder that could only be removed in part is found again.
  fs::remove(lock_of(folder), ignored);
}

/// Removes the folders that killed processes left: those with the right name and owner whose lock
/// is free.
void sweep(const fs::path& root) {
  std::error_code error;
  for (auto entry = fs::directory_iterator(root, error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path lock = entry->path();
    if (!lock.filename().string().starts_with(kFolderPrefix) || lock.extension() != ".lock")
      continue;
    struct stat status {};
    if (::lstat(lock.c_str(), &status) != 0 || status.st_uid != ::geteuid()) continue;
    const Descriptor held = take_lock(lock, 0);
    if (held.valid()) remove_folder(lock.parent_path() / lock.stem());
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

WorkingFolder::WorkingFolder() {
  const fs::path root = temporary_root();
  sweep(root);
  std::string name = (root / (std::string(kFolderPrefix) + "XXXXXX")).string();
  // The folder first: its random name is nobody else's from then on.
  if (::mkdtemp(name.data()) == nullptr) {
    throw_no_space(root.string() + ": no working folder can be made there", errno);
  }
  path_ = name;
  try {
    lock_ = make_lock(lock_of(path_));
  } catch (...) {
    remove_folder(path_);
    throw;
  }
}

WorkingFolder::~WorkingFolder() {
  std::error_code ignored;
  if (kept_) {
    fs::remove(lock_of(path_), ignored);
  } else {
    remove_folder(path_);
  }
}

}  // namespace external_method

void remove_abandoned_working_folders() {
  std::error_code error;
  const std::filesystem::path root = std::filesystem::temp_directory_path(error);
  if (!error) external_method::sweep(root);
}

}  // namespace raymoval
