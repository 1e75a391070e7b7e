// SPDX-License-Identifier: MIT
// Poses and times at their limits.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/clouds/poses.h"
#include "datasets/trajectories/pose_file.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::string tum_says(const std::string& content) {
  const TemporaryFolder folder;
  const auto path = folder.write("poses.txt", content);
  return message_of<DataError>([&] { read_pose_file(path); });
}

}  // namespace

TEST_CASE("times of poses are finite, and poses of one time are near each other", "[poses]") {
  const std::string rest = " 0 0 0 0 0 0 1\n", near = " 0.2 0 0 0 0 0 1\n",
                    far = " 0.21 0 0 0 0 0 1\n";
  check_says(tum_says("5" + rest + "5" + far),
             {"line 2: time 5.000000000 s is that of line 1", "0.21 m apart", "too few digits"});
  // The second row of time 5 is sorted before it is compared.
  check_says(tum_says("5" + rest + "7" + rest + "5" + far), {"line 3: time 5", "line 1"});
  const TemporaryFolder folder;
  CHECK_NOTHROW(read_pose_file(folder.write("near.txt", "5" + rest + "5" + near)));
  check_says(tum_says("nan" + rest), {"line 1", "not finite"});
  check_says(tum_says("5" + rest + "inf" + rest), {"line 2", "not finite"});
  check_says(tum_says("0 0 0 0 nan 0 0 1\n"), {"line 1: the pose holds a number that is not"});
}

TEST_CASE("a calibration row needs a colon and no blank behind it", "[poses]") {
  const TemporaryFolder folder;
  const auto path =
      folder.write("calib.txt", "Tr of this drive\n: 1\nLeft Tr: 1\nTr:1 0 0 4 0 1 0 5 0 0 1 6\n");
  CHECK(read_calibration(path, "Tr").translation() == Eigen::Vector3d(4, 5, 6));
  CHECK(read_calibration(path, "Tr").linear() == Eigen::Matrix3d::Identity());
}
