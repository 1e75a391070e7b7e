// SPDX-License-Identifier: MIT
#include "datasets/clouds/poses.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_calibration(std::string_view bytes) {
  fuzz::may_refuse([&] {
    const Pose pose = read_calibration(fuzz::input_file("calib.txt", bytes), "Tr");
    fuzz::require(pose.matrix().allFinite(), "a calibration is not finite");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(calibration, try_calibration)
