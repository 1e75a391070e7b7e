// SPDX-License-Identifier: MIT
#include "core/process/family_memory.h"

#include <dirent.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/vfs.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/process/proc_files.h"

namespace raymoval {
namespace {

using FileId = std::pair<dev_t, ino_t>;
using FileSizes = std::map<FileId, double>;  ///< In MiB.

double resident_mib(pid_t process) {
  return proc_mib_sum(proc_folder(process) / "status", {"RssAnon", "RssShmem"}).value_or(0.0);
}

bool is_earlier(const timespec& a, const timespec& b) {
  return std::pair(a.tv_sec, a.tv_nsec) < std::pair(b.tv_sec, b.tv_nsec);
}

/// Whether an open file has no disk. The way to it below /proc leads to the file itself, whatever
/// became of its name.
bool is_in_memory(const std::string& descriptor) {
  struct statfs system {};
  if (::statfs(descriptor.c_str(), &system) != 0) return false;
  return system.f_type == TMPFS_MAGIC || system.f_type == RAMFS_MAGIC;
}

/// Adds the files without a disk that a process holds open and that were written since `began`.
void add_open_files(pid_t process, const timespec& began, FileSizes& files) {
  const std::string folder = (proc_folder(process) / "fd").string();
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(::opendir(folder.c_str()), ::closedir);
  if (entries == nullptr) return;
  while (const dirent* entry = ::readdir(entries.get())) {
    struct stat status {};
    if (::fstatat(::dirfd(entries.get()), entry->d_name, &status, 0) != 0) continue;
    if (!S_ISREG(status.st_mode) || status.st_blocks == 0) continue;
    if (is_earlier(status.st_ctim, began)) continue;
    if (!is_in_memory(folder + "/" + entry->d_name)) continue;
    files[{status.st_dev, status.st_ino}] = static_cast<double>(status.st_blocks) / 2048.0;
  }
}

/// Takes away those that a process has mapped: their pages are among its shared memory.
void remove_mapped_files(pid_t process, FileSizes& files) {
  std::ifstream maps(proc_folder(process) / "maps");
  for (std::string line; !files.empty() && std::getline(maps, line);) {
    unsigned int major_number = 0, minor_number = 0;
    unsigned long number = 0;
    if (std::sscanf(line.c_str(), "%*s %*s %*s %x:%x %lu", &major_number, &minor_number, &number) ==
        3) {
      files.erase({makedev(major_number, minor_number), number});
    }
  }
}

}  // namespace

void Pace::end() {
  const Clock::time_point now = Clock::now();
  const auto took = now - begun_;
  earliest_ = now + took;
  next_ = now + std::max<Clock::duration>(rest_, 10 * took);
}

FamilyMemory::FamilyMemory(double limit_mib)
    : limit_mib_(limit_mib),
      share_pace_(std::chrono::milliseconds(20)),
      file_pace_(std::chrono::milliseconds(100)) {
  ::clock_gettime(CLOCK_REALTIME_COARSE, &began_);  // The clock of files.
}

double FamilyMemory::measure(const std::vector<pid_t>& members) {
  double sum = 0.0;
  for (const pid_t process : members) sum += resident_mib(process);
  if (file_pace_.is_due()) {
    file_pace_.begin();
    files_mib_ = unmapped_files_mib(members);
    file_pace_.end();
  }
  if (limit_mib_ <= 0.0 || sum + files_mib_ <= limit_mib_) return sum + files_mib_;
  const double estimate = last_share_mib_ + std::max(0.0, sum - sum_then_mib_) + files_mib_;
  if (share_pace_.is_due() || (estimate > limit_mib_ && share_pace_.may_hurry())) {
    share_pace_.begin();
    last_share_mib_ = proportional_mib(members);
    sum_then_mib_ = sum;
    share_pace_.end();
    return last_share_mib_ + files_mib_;
  }
  return std::min(estimate, limit_mib_);  // No limit is exceeded by an estimate.
}

double FamilyMemory::proportional_mib(const std::vector<pid_t>& members) {
  double mib = 0.0;
  for (const pid_t process : members) {
    const auto share =
        proc_mib_sum(proc_folder(process) / "smaps_rollup", {"Pss_Anon", "Pss_Shmem"});
    const double in_full = share ? 0.0 : resident_mib(process);
    counts_shares_in_full_ = counts_shares_in_full_ || in_full > 0.0;
    mib += share.value_or(in_full);
  }
  return mib;
}

double FamilyMemory::unmapped_files_mib(const std::vector<pid_t>& members) const {
  FileSizes files;
  for (const pid_t process : members) add_open_files(process, began_, files);
  for (const pid_t process : members) remove_mapped_files(process, files);
  double mib = 0.0;
  for (const auto& [file, size] : files) mib += size;
  return mib;
}

}  // namespace raymoval
