// SPDX-License-Identifier: MIT
#include "core/process/family_memory.h"

#include <linux/magic.h>
#include <sys/sysmacros.h>
#include <sys/vfs.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
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

/// Whether an open file has no disk. Its path below /proc leads to the file itself, also after the
/// file was renamed or deleted.
bool is_in_memory(const std::string& descriptor) {
  struct statfs system {};
  if (::statfs(descriptor.c_str(), &system) != 0) return false;
  return system.f_type == TMPFS_MAGIC || system.f_type == RAMFS_MAGIC;
}

/// Adds the files without a disk that a process holds open and that were written since `began`.
void add_open_files(pid_t process, const timespec& began, FileSizes& files) {
  for (const OpenFile& file : open_files(process)) {
    const struct stat& status = file.status;
    if (status.st_blocks == 0 || is_earlier(status.st_ctim, began)) continue;
    if (!is_in_memory(file.path)) continue;
    files[{status.st_dev, status.st_ino}] = size_mib(status);
  }
}

/// Removes the files that a process has mapped: its shared memory includes their pages.
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

timespec file_clock() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME_COARSE, &now);
  return now;
}

FamilyMemory::FamilyMemory(double limit_mib, timespec (*clock)())
    : limit_mib_(limit_mib),
      clock_(clock),
      began_(clock()),
      share_pace_(std::chrono::milliseconds(20)),
      file_pace_(std::chrono::milliseconds(100)) {}

/// If the clock was set back, files that were written since then have earlier times.
void FamilyMemory::follow_clock() {
  using std::chrono::nanoseconds;
  constexpr long kSecond = 1'000'000'000;
  const auto since = std::chrono::duration_cast<nanoseconds>(Pace::Clock::now() - last_look_);
  last_look_ += since;
  // The expected time of the clock at the last measurement.
  timespec then = clock_();
  then.tv_sec -= since.count() / kSecond;
  then.tv_nsec -= since.count() % kSecond;
  if (then.tv_nsec < 0) {
    --then.tv_sec;
    then.tv_nsec += kSecond;
  }
  if (is_earlier(then, began_)) began_ = then;
}

double FamilyMemory::measure(const std::vector<pid_t>& members) {
  follow_clock();
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
