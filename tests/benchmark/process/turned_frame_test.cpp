// SPDX-License-Identifier: MIT
// The frame that points are stored in must not change verdicts: a vehicle's, an IMU's or a
// camera's.
#include <catch2/catch.hpp>
#include <memory>
#include <random>

#include "benchmark/process/method_run.h"
#include "core/scan/local_frame.h"
#include "datasets/open_sequence.h"
#include "methods/registry.h"
#include "tests/methods/moved_world.h"

using namespace raymoval;

namespace {

Sequence street() {
  SequenceOptions options;
  options.frames = FrameRange{0, 27, 3};
  return open_sequence("street", options);
}

MaskStore masks_of(const std::string& method, const Sequence& sequence) {
  const MethodRequest request{method, MethodRegistry::built_in().configure(method)};
  const MethodAnswer answer = run_method({&sequence, &request, {2}});
  INFO(answer.reason);
  REQUIRE(answer.status == CellStatus::kOk);
  return answer.masks;
}

MaskStore masks_in_frame(const std::string& method, Sequence sequence,
                         const Eigen::Matrix3d& turn) {
  sequence.opened = sequence.scans = std::make_shared<toy::ChangedScans>(
      sequence.scans, [&](Scan& scan) { turn_sensor_frame(turn, scan); });
  return masks_of(method, sequence);
}

}  // namespace

TEST_CASE("an exchange of the axes of points changes no verdict", "[frames]") {
  const Sequence sequence = street();
  Eigen::Matrix3d turn;  // z becomes -y, which is up in a camera's frame.
  turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  for (const char* method : {"raymoval_plus:online-lag", "raymoval"}) {
    INFO(method);
    const MaskStore here = masks_of(method, sequence);
    CHECK(here.removed_count() > 100);
    CHECK(toy::different_verdicts(here, masks_in_frame(method, sequence, turn), here.size()) == 0);
  }
}

TEST_CASE("any frame of the points gives nearly the same verdicts", "[frames][slow]") {
  const Sequence sequence = street();
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (const char* method : {"raymoval_plus:offline", "raymoval_plus:online-lag"}) {
    const MaskStore here = masks_of(method, sequence);
    for (int round = 0; round < 2; ++round) {
      const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
      const Eigen::Quaterniond turn = Eigen::Quaterniond(w, x, y, z).normalized();
      INFO(method << ", turned by " << turn.coeffs().transpose());
      // Beams on the borders of rows may fall into the next row.
      CHECK(toy::different_verdicts(here, masks_in_frame(method, sequence, turn.toRotationMatrix()),
                                    here.size()) < here.point_count() / 500);
    }
  }
}
