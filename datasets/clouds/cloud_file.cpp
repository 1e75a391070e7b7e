// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_file.h"

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/clouds/bin/bin_file.h"
#include "datasets/clouds/format/point_layout.h"
#include "datasets/clouds/pcd/pcd_header.h"
#include "datasets/clouds/poses.h"
#include "datasets/clouds/record_file.h"

namespace raymoval {
namespace {

std::string_view text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Cloud read_cloud(const std::filesystem::path& path, const Eigen::Vector3d& origin,
                 const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  const std::vector<std::byte> bytes = read_bytes(path);
  return format.read_cloud({path, text_of(bytes), reading}, origin);
}

PointRecords read_records(const std::filesystem::path& path, const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  const std::vector<std::byte> bytes = read_bytes(path);
  return format.read_records({path, text_of(bytes), reading});
}

void check_bin_size(const std::filesystem::path& path, std::uintmax_t bytes,
                    const RecordReading& reading) {
  check_bin_rows(path, bytes, bin_layout(reading.point_layout));
}

Pose read_viewpoint(const std::filesystem::path& path) {
  const auto viewpoint = parse_pcd_header(read_piece(path, 0, 65536), path).viewpoint;
  if (!viewpoint) {
    throw DataError(path.string() + ": the header has no VIEWPOINT; expected the sensor pose as " +
                    "tx ty tz qw qx qy qz.");
  }
  return rigid_pose(viewpoint->head<3>(), viewpoint->tail<4>(), path.string() + ": VIEWPOINT");
}

}  // namespace raymoval
