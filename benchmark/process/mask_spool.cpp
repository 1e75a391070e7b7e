// SPDX-License-Identifier: MIT
#include "benchmark/process/mask_spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "benchmark/process/checked_sink.h"
#include "core/error.h"
#include "core/files/part_name.h"

namespace raymoval {

MaskSpool::MaskSpool(std::string method, const TimedSource& scans,
                     const std::filesystem::path& beside)
    : method_(std::move(method)),
      scans_(scans),
      path_(new_part_name(beside.string() + ".masks")),
      file_(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600)),
      entries_(scans.size()) {
  if (file_ < 0) fail("cannot be made");
  ::unlink(path_.c_str());  // It lives as long as it is open, however the program ends.
}

MaskSpool::~MaskSpool() {
  if (file_ >= 0) ::close(file_);
}

void MaskSpool::fail(const char* what) const {
  throw DataError(path_.string() + ": the file for masks " + what + " (" +
                  std::generic_category().message(errno) +
                  "). Nothing was changed; free space or choose another place for -o.");
}

void MaskSpool::accept(std::size_t scan, const Mask& mask) {
  check_answer(method_, scans_, scan, mask);
  std::vector<std::uint8_t> bits((mask.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | mask[i] << (i % 8));
  }
  const std::lock_guard lock(mutex_);
  if (entries_[scan].filled) throw_second_answer(method_, scan);
  for (std::size_t done = 0; done < bits.size();) {
    const ssize_t put =
        ::pwrite(file_, bits.data() + done, bits.size() - done, static_cast<off_t>(size_ + done));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) fail("cannot be written");
    done += static_cast<std::size_t>(put);
  }
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
  std::vector<std::uint8_t> bits((entry.points + 7) / 8);
  for (std::size_t done = 0; done < bits.size();) {
    const ssize_t got = ::pread(file_, bits.data() + done, bits.size() - done,
                                static_cast<off_t>(entry.offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("cannot be read");
    done += static_cast<std::size_t>(got);
  }
  Mask mask(entry.points);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    mask[i] = static_cast<std::uint8_t>(bits[i / 8] >> (i % 8) & 1);
  }
  return mask;
}

std::uint64_t MaskSpool::point_count() const {
  std::uint64_t points = 0;
  for (const Entry& entry : entries_) points += entry.points;
  return points;
}

}  // namespace raymoval
