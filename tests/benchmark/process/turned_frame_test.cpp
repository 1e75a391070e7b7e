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

using namespace raymoval;

namespace {

/// The scans of the street with their points and poses in a turned frame.
class TurnedScans : public ScanSource {
 public:
  TurnedScans(const ScanSource& scans, const Eigen::Matrix3d& turn) : scans_(scans), turn_(turn) {}
  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan = scans_.load(index);
    turn_sensor_frame(turn_, scan);
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override {
    return scans_.pose(index) * Pose(turn_.transpose());
  }
  [[nodiscard]] const SensorModel& sensor() const override { return scans_.sensor(); }

 private:
  const ScanSource& scans_;
  Eigen::Matrix3d turn_;
};

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
  const auto upright = sequence.scans;  // Is read through by the turned scans.
  sequence.opened = sequence.scans = std::make_shared<TurnedScans>(*upright, turn);
  return masks_of(method, sequence);
}

std::size_t differences(const MaskStore& a, const MaskStore& b) {
  std::size_t count = 0;
  for (std::size_t scan = 0; scan < a.size(); ++scan) {
    const Mask left = a.get(scan), right = b.get(scan);
    REQUIRE(left.size() == right.size());
    for (std::size_t i = 0; i < left.size(); ++i) count += left[i] != right[i] ? 1 : 0;
  }
  return count;
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
    CHECK(differences(here, masks_in_frame(method, sequence, turn)) == 0);
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
      CHECK(differences(here, masks_in_frame(method, sequence, turn.toRotationMatrix())) <
            here.point_count() / 500);
    }
  }
}
