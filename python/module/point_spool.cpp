// SPDX-License-Identifier: MIT
#include "python/module/point_spool.h"

#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/part_name.h"

namespace raymoval::python {
namespace {

std::filesystem::path temporary_folder() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  return error ? "/tmp" : folder;
}

template <class Value>
std::string_view bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

}  // namespace

PointSpool::PointSpool() : folder_(temporary_folder()) {
  Part part = new_part_file(folder_ / "raymoval-scans", 0600);
  if (!part.held.valid()) fail("cannot be made");
  file_ = std::move(part.held);
  ::unlink(part.place.c_str());  // It lives as long as it is open, however the program ends.
}

void PointSpool::fail(const char* what) const {
  throw DataError(folder_.string() + ": the file for the scans of a generator " + what + " (" +
                  std::generic_category().message(errno) +
                  "). Set TMPDIR to a folder with more space, or give the scans as a sequence that "
                  "can be asked for each of them.");
}

void PointSpool::add(const Cloud& cloud) {
  const Entry entry{size_, cloud.points.size(), !cloud.intensity.empty()};
  for (const std::string_view bytes : {bytes_of(cloud.points), bytes_of(cloud.intensity)}) {
    if (!write_at(file_.get(), bytes, size_)) fail("cannot be written");
    size_ += bytes.size();
  }
  entries_.push_back(entry);
}

Cloud PointSpool::points(std::size_t scan) const {
  const Entry& entry = entries_[scan];
  Cloud cloud;
  cloud.points.resize(entry.points);
  if (entry.has_reflectance) cloud.intensity.resize(entry.points);
  std::uint64_t offset = entry.offset;
  const auto read = [&](auto& values) {
    const std::size_t bytes = values.size() * sizeof(values[0]);
    if (read_at(file_.get(), values.data(), bytes, offset) != bytes) fail("cannot be read");
    offset += bytes;
  };
  read(cloud.points);
  read(cloud.intensity);
  return cloud;
}

}  // namespace raymoval::python
