// SPDX-License-Identifier: MIT
#include "benchmark/process/mask_spool.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "benchmark/process/checked_sink.h"
#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/part_name.h"
#include "core/scan/packed_mask.h"

namespace raymoval {

MaskSpool::MaskSpool(std::string method, const TimedSource& scans,
                     const std::filesystem::path& beside)
    : method_(std::move(method)), scans_(scans), path_(beside), entries_(scans.size()) {
  Part part = new_part_file(beside, 0600);
  if (!part.held.valid()) fail("cannot be made");
  file_ = std::move(part.held);
  ::unlink(part.place.c_str());  // It lives as long as it is open, however the program ends.
}

void MaskSpool::fail(const char* what) const {
  throw DataError(path_.string() + ": the file for masks beside it " + what + " (" +
                  std::generic_category().message(errno) +
                  "). Nothing was changed; free space or choose another place for -o.");
}

void MaskSpool::accept(std::size_t scan, const Mask& mask) {
  check_answer(method_, scans_, scan, mask);
  const std::string bits = packed_mask(mask);
  const std::lock_guard lock(mutex_);
  if (entries_[scan].filled) throw_second_answer(method_, scan);
  if (!write_at(file_.get(), bits, size_)) fail("cannot be written");
  entries_[scan] = {true, size_, mask.size()};
  size_ += bits.size();
  removed_ += static_cast<std::uint64_t>(std::count(mask.begin(), mask.end(), 1));
}

void MaskSpool::check_complete() const {
  for (std::size_t scan = 0; scan < entries_.size(); ++scan) {
    if (!entries_[scan].filled) throw_missing_answer(method_, scan, entries_.size());
  }
}

Mask MaskSpool::get(std::size_t scan) const {
  const Entry& entry = entries_[scan];
  const std::string bits = read_at(file_.get(), (entry.points + 7) / 8, entry.offset);
  if (bits.size() < (entry.points + 7) / 8) fail("cannot be read");
  return unpacked_mask(bits, entry.points);
}

std::uint64_t MaskSpool::point_count() const {
  std::uint64_t points = 0;
  for (const Entry& entry : entries_) points += entry.points;
  return points;
}

}  // namespace raymoval
