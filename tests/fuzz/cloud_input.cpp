// SPDX-License-Identifier: MIT
#include "tests/fuzz/cloud_input.h"

#include <cstring>

#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/cloud_writer.h"
#include "datasets/clouds/file_source.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

template <class Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

void write_and_read(const Cloud& cloud, const std::string& name) {
  const auto path = input_file(name, "");
  write_cloud(path, cloud.points, cloud.intensity);
  const Cloud again = read_cloud(path);
  require(same_bytes(cloud.points, again.points), "points change when written and read");
  require(cloud.intensity.empty() || same_bytes(cloud.intensity, again.intensity),
          "intensities change when written and read");
}

void read_as_scan(const std::filesystem::path& path) {
  FrameEntry frame;
  frame.path = path;
  const FileScanSource source({frame}, {}, std::nullopt);
  const Scan scan = source.load(0);
  require(scan.size() + scan.left_out_count() == scan.stored_point_count,
          "points of a scan are lost");
  for (const Eigen::Vector3f& point : scan.points) {
    require(point.allFinite(), "a point of a scan is not finite");
  }
  may_refuse([&] {
    const auto labels = IntensityLabelSource({frame}).labels(scan);
    require(labels.size() == scan.size(), "a scan has another count of labels");
  });
  (void)source.sensor();
}

}  // namespace

void try_cloud(const std::string& name, std::string_view bytes) {
  const auto path = input_file(name, bytes);
  may_refuse([&] {
    const Cloud cloud = read_cloud(path);
    require(cloud.points.size() <= bytes.size(), "a file gives more points than it has bytes");
    require(cloud.intensity.empty() || cloud.intensity.size() == cloud.points.size(),
            "points and intensities differ in number");
    write_and_read(cloud, name.ends_with(".pcd") ? "again.ply" : "again.pcd");
  });
  may_refuse([&] { read_as_scan(path); });
}

}  // namespace raymoval::fuzz
