// SPDX-License-Identifier: MIT
// Scans: clouds, and the labels and removals of a scan.
#include <cstring>

#include "benchmark/result/removals/removal_files.h"
#include "core/scan/label_rule.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "tests/datasets/written_cloud.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"
#include "tests/methods/held_scans.h"

namespace raymoval::fuzz {
namespace {

template <class Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

void write_and_read(const Cloud& cloud, const std::string& name) {
  const auto path = input_file(name, "");
  test::write_cloud(path, cloud.points, cloud.intensity);
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

/// Tries `bytes` as the cloud file `name`: as a cloud that is written and read again, as a scan,
/// and as a scan whose intensities are labels.
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

/// A scan of a point per label, save that the file may be a few bytes too long.
class OneScan : public toy::HeldScans {
 public:
  explicit OneScan(std::size_t stored) {
    Scan scan;
    scan.name = "000000";
    // Every third point of the file is not finite, and so no point of the scan.
    for (std::size_t i = 0; i < stored; ++i) {
      if (i % 3 != 2) scan.stored_index.push_back(static_cast<std::uint32_t>(i));
    }
    scan.points.resize(scan.stored_index.size(), Eigen::Vector3f::Zero());
    add_scan(std::move(scan));
    scans_[0].stored_point_count = stored;
  }
};

RAYMOVAL_FUZZ_TARGET(bin) {
  try_cloud("scan.bin", bytes);
}

RAYMOVAL_FUZZ_TARGET(pcd) {
  try_cloud("scan.pcd", bytes);
  may_refuse([&] {
    const Pose pose = read_viewpoint(input_file("viewpoint.pcd", bytes));
    require(pose.matrix().allFinite(), "a pose is not finite");
  });
}

RAYMOVAL_FUZZ_TARGET(ply) {
  try_cloud("scan.ply", bytes);
}

RAYMOVAL_FUZZ_TARGET(label) {
  const auto path = input_file("000000.label", bytes);
  const OneScan scans(bytes.size() / sizeof(std::uint32_t));
  const Scan scan = scans.load(0);
  may_refuse([&] {
    FrameEntry frame;
    frame.label_path = path;
    const auto words = LabelFileSource({frame}).labels(scan);
    require(words.size() == scan.size(), "a scan has another count of labels");
    for (const std::uint32_t word : words) (void)LabelRule().classify(word);
  });
  may_refuse([&] {
    const MaskStore masks = read_removals(path.parent_path(), scans, [] {});
    require(masks.point_count(0) == scan.size(), "a scan has another size than its mask");
  });
}

}  // namespace
}  // namespace raymoval::fuzz
