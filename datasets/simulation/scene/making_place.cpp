// SPDX-License-Identifier: MIT
#include "datasets/simulation/scene/making_place.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/part_name.h"

namespace raymoval::simulated {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = "lock";

/// The running kernel and the mounted file system of an open lock file: two processes for which
/// these are the same see each other's locks. Containers of one machine share both.
/// @return empty if the system does not tell
std::string lock_domain(int file) {
  std::ifstream boot("/proc/sys/kernel/random/boot_id");
  std::string text;
  struct stat status {};
  if (!std::getline(boot, text) || ::fstat(file, &status) != 0) return "";
  return text + " " + std::to_string(status.st_dev) + " " + std::to_string(status.st_ino) + "\n";
}

bool locks(int file) {
  return ::flock(file, LOCK_EX | LOCK_NB) == 0;
}

/// Whether the process that made `place` has certainly ended; then `lock` holds the place's lock.
bool is_dead(const fs::path& place, Descriptor& lock) {
  const fs::path file = place / kLockName;
  lock = Descriptor(::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!lock.valid() || !locks(lock.get())) return false;
  const std::string domain = lock_domain(lock.get());
  std::string written(domain.size() + 1, '\0');
  const ssize_t got = ::pread(lock.get(), written.data(), written.size(), 0);
  written.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  return !domain.empty() && written == domain;
}

/// The lock last, so that a place that could only be removed in part is found again.
void remove_place(const fs::path& place, Descriptor& lock) {
  std::error_code ignored;
  for (fs::directory_iterator entry(place, ignored); entry != fs::directory_iterator();
       entry.increment(ignored)) {
    if (entry->path().filename() != kLockName) fs::remove_all(entry->path(), ignored);
  }
  fs::remove(place / kLockName, ignored);
  lock.close();
  fs::remove(place, ignored);
}

fs::path parent_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw DataError(path.string() + ": cannot be made (" + reason +
                  "). Choose a folder you may write to.");
}

}  // namespace

MakingPlace::MakingPlace(fs::path target) : target_(std::move(target)) {
  while (!make_locked()) continue;
  std::error_code error;
  fs::create_directory(folder(), error);
  if (!error) return;
  remove_place(path_, lock_);
  fail(folder(), error.message());
}

/// @return false if another process took it for dead before it was locked
bool MakingPlace::make_locked() {
  path_ = new_part_name(target_);
  std::error_code error;
  fs::create_directory(path_, error);
  if (error) fail(path_, error.message());
  const fs::path file = path_ / kLockName;
  lock_ = Descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!lock_.valid()) {
    const int reason = errno;
    remove_place(path_, lock_);
    fail(path_, std::generic_category().message(reason));
  }
  // Without locks on this file system nobody takes the place for dead.
  if (!locks(lock_.get())) return errno != EWOULDBLOCK;
  const std::string domain = lock_domain(lock_.get());
  [[maybe_unused]] const ssize_t put = ::write(lock_.get(), domain.data(), domain.size());
  return true;
}

MakingPlace::~MakingPlace() {
  remove_place(path_, lock_);
}

bool MakingPlace::take_place() {
  if (::rename(folder().c_str(), target_.c_str()) != 0) {
    if (errno == EEXIST || errno == ENOTEMPTY || errno == ENOTDIR) return false;
    fail(target_, std::generic_category().message(errno));
  }
  sync_folder(parent_of(target_));
  return true;
}

bool MakingPlace::replace_target() {
  // In one step where the file system can do that, so that readers always find one of the two.
  if (::renameat2(AT_FDCWD, folder().c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
    sync_folder(parent_of(target_));
    return true;
  }
  const fs::path aside = path_ / "replaced";
  if (::rename(target_.c_str(), aside.c_str()) != 0 && errno != ENOENT) {
    throw DataError(target_.string() + ": cannot be replaced (" +
                    std::generic_category().message(errno) +
                    "). Remove it, or choose another folder.");
  }
  return take_place();
}

void sweep_making_places(const fs::path& parent) {
  for (const fs::path& entry : entries_of(parent)) {
    if (!is_part_name(entry)) continue;
    Descriptor lock;
    if (is_dead(entry, lock)) remove_place(entry, lock);
  }
}

}  // namespace raymoval::simulated
