// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_file.h"
#include "tests/fuzz/cloud_input.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_pcd(std::string_view bytes) {
  fuzz::try_cloud("scan.pcd", bytes);
  fuzz::may_refuse([&] {
    const Pose pose = read_viewpoint(fuzz::input_file("viewpoint.pcd", bytes));
    fuzz::require(pose.matrix().allFinite(), "a pose is not finite");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(pcd, try_pcd)
