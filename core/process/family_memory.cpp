// SPDX-License-Identifier: MIT
#include "core/process/family_memory.h"

#include <algorithm>

#include "core/process/proc_files.h"

namespace raymoval {
namespace {

double resident_mib(pid_t process) {
  return proc_mib_sum(proc_folder(process) / "status", {"RssAnon", "RssShmem"}).value_or(0.0);
}

}  // namespace

void Pace::end() {
  const Clock::time_point now = Clock::now();
  const auto took = now - begun_;
  earliest_ = now + took;
  next_ = now + std::max<Clock::duration>(rest_, 10 * took);
}

double FamilyMemory::measure(const std::vector<pid_t>& members) {
  double sum = 0.0;
  for (const pid_t process : members) sum += resident_mib(process);
  if (limit_mib_ <= 0.0 || sum <= limit_mib_) return sum;
  const double estimate = last_share_mib_ + std::max(0.0, sum - sum_then_mib_);
  if (share_pace_.is_due() || (estimate > limit_mib_ && share_pace_.may_hurry())) {
    share_pace_.begin();
    last_share_mib_ = proportional_mib(members);
    sum_then_mib_ = sum;
    share_pace_.end();
    return last_share_mib_;
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

}  // namespace raymoval
