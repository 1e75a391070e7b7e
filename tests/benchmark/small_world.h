// SPDX-License-Identifier: MIT
#pragma once

#include "tests/datasets/temporary_folder.h"
#include "tests/methods/held_scans.h"

namespace raymoval::test {

/// Two scans: "000007" has three points, of five stored (positions 0, 2 and 4); "000008" has one.
class TwoScans : public toy::HeldScans {
 public:
  TwoScans() {
    add({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
    add({{1, 0, 0}});
    scans_[0].name = "000007";
    scans_[0].stored_point_count = 5;
    scans_[0].stored_index = {0, 2, 4};
    scans_[1].name = "000008";
  }
};

/// A sequence of one scan with a static and a moving point, in the folder's layout of KITTI.
inline void write_drive(const TemporaryFolder& folder, const std::string& place) {
  (void)folder.write(place + "/velodyne/000000.bin", floats({5, 0, 0, 0, 5, 10, 0, 0}));
  (void)folder.write(place + "/labels/000000.label", words({40, 252}));
  (void)folder.write(place + "/poses.txt", kIdentityRow);
  (void)folder.write(place + "/calib.txt", "Tr: " + kIdentityRow);
}

}  // namespace raymoval::test
