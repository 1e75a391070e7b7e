// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "core/files/files.h"
#include "datasets/clouds/cloud_file.h"

namespace raymoval::test {

/// Writes points as a file of the format of `path`, in float32.
/// @param intensity as long as `points`, or empty: then there is no such field, and .bin has zeros
inline void write_cloud(const std::filesystem::path& path,
                        const std::vector<Eigen::Vector3f>& points,
                        const std::vector<float>& intensity = {}) {
  PointRecords records;
  for (const char* axis : {"x", "y", "z"}) records.layout.add(axis, 'F', 4);
  if (!intensity.empty() || path.extension() == ".bin") records.layout.add("intensity", 'F', 4);
  records.width = points.size();
  records.bytes.resize(points.size() * records.layout.row_bytes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(records.row(i), points[i].data(), 3 * sizeof(float));
    if (!intensity.empty()) std::memcpy(records.row(i) + 12, &intensity[i], sizeof(float));
  }
  write_atomically(path, whole_file(path, records));
}

}  // namespace raymoval::test
