// SPDX-License-Identifier: MIT
#include "python/module/point_spool.h"

#include <cstring>
#include <string>

#include "core/files/scratch_folder.h"

namespace raymoval::python {
namespace {

ScanSpool generator_spool() {
  return {0, scratch_root() / "raymoval-scans", "the scans of a generator (TMPDIR says where)"};
}

template <class Value>
std::string bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

template <class Value>
std::vector<Value> values_of(const std::string& bytes) {
  std::vector<Value> values(bytes.size() / sizeof(Value));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  return values;
}

}  // namespace

PointSpool::PointSpool() : points_(generator_spool()), intensities_(generator_spool()) {}

void PointSpool::add(const Cloud& cloud) {
  points_.append(bytes_of(cloud.points));
  intensities_.append(bytes_of(cloud.intensity));
}

Cloud PointSpool::points(std::size_t scan) const {
  Cloud cloud;
  cloud.points = values_of<Eigen::Vector3f>(points_.get(scan));
  cloud.intensity = values_of<float>(intensities_.get(scan));
  return cloud;
}

}  // namespace raymoval::python
