// SPDX-License-Identifier: MIT
#include "benchmark/process/mask_spool.h"

#include <algorithm>
#include <utility>

#include "core/scan/packed_mask.h"

namespace raymoval {

MaskSpool::MaskSpool(std::string method, const TimedSource& scans,
                     const std::filesystem::path& beside)
    : method_(std::move(method)),
      scans_(scans),
      file_("masks", beside, scans.size()),
      entries_(scans.size()) {}

void MaskSpool::accept(std::size_t scan, const Mask& mask) {
  check_answer(method_, scans_, scan, mask);
  const std::string bits = packed_mask(mask);
  const std::lock_guard lock(mutex_);
  if (entries_[scan].filled) throw_second_answer(method_, scan);
  file_.put(scan, bits);
  entries_[scan] = {true, mask.size()};
  removed_ += static_cast<std::uint64_t>(std::count(mask.begin(), mask.end(), 1));
}

void MaskSpool::check_complete() const {
  for (std::size_t scan = 0; scan < entries_.size(); ++scan) {
    if (!entries_[scan].filled) throw_missing_answer(method_, scan, entries_.size());
  }
}

Mask MaskSpool::get(std::size_t scan) const {
  return unpacked_mask(file_.get(scan), entries_[scan].points);
}

std::uint64_t MaskSpool::point_count() const {
  std::uint64_t points = 0;
  for (const Entry& entry : entries_) points += entry.points;
  return points;
}

}  // namespace raymoval
