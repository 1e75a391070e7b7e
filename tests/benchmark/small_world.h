// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan_source.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval::test {

/// Two scans: "000007" has three points, of five stored (positions 0, 2 and 4); "000008" has one.
class TwoScans : public ScanSource {
 public:
  [[nodiscard]] std::size_t size() const override { return 2; }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan;
    scan.index = index;
    if (index == 0) {
      scan.name = "000007";
      scan.points = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
      scan.stored_point_count = 5;
      scan.stored_index = {0, 2, 4};
    } else {
      scan.name = "000008";
      scan.points = {{1, 0, 0}};
      scan.stored_point_count = 1;
    }
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t) const override { return Pose::Identity(); }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }

 private:
  SensorModel sensor_;
};

/// A sequence of one scan with a static and a moving point, in the folder's layout of KITTI.
inline void write_drive(const TemporaryFolder& folder, const std::string& place) {
  (void)folder.write(place + "/velodyne/000000.bin", floats({5, 0, 0, 0, 5, 10, 0, 0}));
  (void)folder.write(place + "/labels/000000.label", words({40, 252}));
  (void)folder.write(place + "/poses.txt", kIdentityRow);
  (void)folder.write(place + "/calib.txt", "Tr: " + kIdentityRow);
}

}  // namespace raymoval::test
