// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_file.h"

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/clouds/bin/bin_file.h"
#include "datasets/clouds/format/deflate.h"
#include "datasets/clouds/format/point_layout.h"
#include "datasets/clouds/pcd/pcd_header.h"
#include "datasets/clouds/poses.h"
#include "datasets/clouds/record_file.h"

namespace raymoval {
namespace {

/// Refuses what git-lfs leaves in the place of a file that was not fetched.
void check_no_pointer(const std::filesystem::path& path, std::string_view text) {
  if (!text.starts_with("version https://git-lfs.github.com/spec/")) return;
  throw DataError(path.string() +
                  ": is a pointer of git-lfs to the file, which was not fetched. Fetch it: `git "
                  "lfs pull`.");
}

/// Calls `read` with the content of a file of points, unpacked.
template <class Read>
auto read_unpacked(const std::filesystem::path& path, const RecordReading& reading, Read&& read) {
  const std::vector<std::byte> bytes = read_bytes(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  check_no_pointer(path, text);
  if (!is_packed(path)) return read(CloudBytes{path, text, reading});
  const std::string unpacked = unpack_gzip(text, path.string());
  return read(CloudBytes{path, unpacked, reading});
}

}  // namespace

Cloud read_cloud(const std::filesystem::path& path, const Eigen::Vector3d& origin,
                 const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  return read_unpacked(path, reading,
                       [&](const CloudBytes& file) { return format.read_cloud(file, origin); });
}

PointRecords read_records(const std::filesystem::path& path, const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  return read_unpacked(path, reading,
                       [&](const CloudBytes& file) { return format.read_records(file); });
}

RecordLayout read_layout(const std::filesystem::path& path, const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  const bool by_itself = format.read_layout != nullptr && !is_packed(path);
  return by_itself ? format.read_layout(path, reading) : read_records(path, reading).layout;
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
