// SPDX-License-Identifier: MIT
#include "benchmark/result/removal_files.h"
#include "core/scan/label_rule.h"
#include "datasets/clouds/file_source.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

/// A scan of a point per label, save that the file may be a few bytes too long.
class OneScan : public ScanSource {
 public:
  explicit OneScan(std::size_t stored) {
    scan_.name = "000000";
    scan_.stored_point_count = stored;
    // Every third point of the file is not finite, and so no point of the scan.
    for (std::size_t i = 0; i < stored; ++i) {
      if (i % 3 != 2) scan_.stored_index.push_back(static_cast<std::uint32_t>(i));
    }
    scan_.points.resize(scan_.stored_index.size(), Eigen::Vector3f::Zero());
  }
  [[nodiscard]] std::size_t size() const override { return 1; }
  [[nodiscard]] Scan load(std::size_t) const override { return scan_; }
  [[nodiscard]] Pose pose(std::size_t) const override { return Pose::Identity(); }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }

 private:
  Scan scan_;
  SensorModel sensor_;
};

void try_label(std::string_view bytes) {
  const auto path = fuzz::input_file("000000.label", bytes);
  const OneScan scans(bytes.size() / sizeof(std::uint32_t));
  const Scan scan = scans.load(0);
  fuzz::may_refuse([&] {
    FrameEntry frame;
    frame.label_path = path;
    const auto words = LabelFileSource({frame}).labels(scan);
    fuzz::require(words.size() == scan.size(), "a scan has another count of labels");
    for (const std::uint32_t word : words) (void)LabelRule().classify(word);
  });
  fuzz::may_refuse([&] {
    const MaskStore masks = read_removals(path.parent_path(), scans, [] {});
    fuzz::require(masks.point_count(0) == scan.size(), "a scan has another size than its mask");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(label, try_label)
