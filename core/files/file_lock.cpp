// SPDX-License-Identifier: MIT
#include "core/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/error.h"
#include "core/files/files.h"

namespace raymoval {
namespace {

std::string host_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "an unknown host";
}

/// Whether the system's error number means that a file system has no locks at all. ENOLCK does not:
/// a lock server that does not respond may have given the lock to another process before.
bool means_no_locks(int reason) {
  return reason == ENOSYS || reason == ENOTSUP || reason == EINVAL;
}

}  // namespace

FileLock::~FileLock() {
  if (!file_.valid()) return;
  // The last holder removes the file; waiting processes check its name again.
  if (::flock(file_.get(), LOCK_EX | LOCK_NB) == 0) {
    if (is_still_there()) ::unlink(path_.c_str());
  } else if (means_no_locks(errno)) {
    remove_if_new();
  }
}

FileLock::State FileLock::take(Mode mode) {
  const int kind = mode == Mode::kExclusive ? LOCK_EX : LOCK_SH;
  while (true) {
    if (!file_.valid()) open();
    if (::flock(file_.get(), kind | LOCK_NB) == 0) {
      if (is_still_there()) break;
      file_.close();  // Between open and flock the holder before has removed the file.
      continue;
    }
    const int reason = errno;
    if (reason == EINTR) continue;
    if (reason == EWOULDBLOCK) return State::kBusy;
    if (means_no_locks(reason)) return State::kNoLocks;
    remove_if_new();
    throw DataError(path_.string() + ": cannot be locked (" +
                    std::generic_category().message(reason) +
                    "), so another process may be using it. Check that you own the file, and that "
                    "its disk or share is reachable and supports locks.");
  }
  write_holder();
  return State::kHeld;
}

void FileLock::open() {
  constexpr int kFlags = O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW;
  file_ = Descriptor(::open(path_.c_str(), kFlags | O_EXCL, 0666));
  is_new_ = file_.valid();
  if (!is_new_) file_ = Descriptor(::open(path_.c_str(), kFlags, 0666));
  if (file_.valid()) return;
  const int reason = errno;
  // Another user's lock file: locks work on it, except on some network file systems.
  if (reason == EACCES) {
    file_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
    if (file_.valid()) return;
  }
  throw DataError(path_.string() + ": cannot be written (" +
                  std::generic_category().message(reason) + ").");
}

void FileLock::remove_if_new() {
  if (is_new_ && is_still_there()) ::unlink(path_.c_str());
}

bool FileLock::is_still_there() const {
  struct stat held {};
  struct stat named {};
  return ::fstat(file_.get(), &held) == 0 && ::stat(path_.c_str(), &named) == 0 &&
         held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

std::string FileLock::holder() const {
  try {
    std::string text = read_text(path_);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    if (!text.empty()) return text;
  } catch (const DataError&) {
    // It went away meanwhile.
  }
  return "a process that has not written its name yet";
}

void FileLock::write_holder() const {
  const std::string text = "process " + std::to_string(::getpid()) + " on " + host_name() + "\n";
  // Only for a message, so a full disk is ignored here.
  if (::ftruncate(file_.get(), 0) != 0) return;
  [[maybe_unused]] const ssize_t put = ::pwrite(file_.get(), text.data(), text.size(), 0);
}

}  // namespace raymoval
