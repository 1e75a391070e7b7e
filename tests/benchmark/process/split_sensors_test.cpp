// SPDX-License-Identifier: MIT
#include "benchmark/process/split_sensors.h"

#include <catch2/catch.hpp>
#include <map>
#include <memory>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// Removes points nearer than 3 m to where their beams start.
class NearRemover : public Remover {
 public:
  explicit NearRemover(std::size_t answers = 1) : answers_(answers) {}
  void run(const ScanSource& scans, RemovalSink& sink, const RunContext&) override {
    // Last scan first: the pieces of a cloud come in any order.
    for (std::size_t i = scans.size(); i-- > 0;) {
      const Scan scan = scans.load(i);
      CHECK(scan.index == i);
      CHECK(scan.T_world_sensor.isApprox(scans.pose(i)));
      starts.push_back(scan.T_world_sensor.translation());
      Mask mask;
      for (const auto& point : scan.points) mask.push_back(point.norm() < 3.0F ? 1 : 0);
      for (std::size_t k = 0; k < answers_; ++k) sink.accept(i, mask);
    }
  }
  std::vector<Eigen::Vector3d> starts;

 private:
  std::size_t answers_;
};

class Masks : public RemovalSink {
 public:
  void accept(std::size_t scan, const Mask& mask) override { all[scan] = mask; }
  std::map<std::size_t, Mask> all;
};

/// Two clouds along x. The vehicle is at x = 10 and 20; sensor 7 is 4 m ahead of it, sensor 3 is at
/// its origin. One point lies at sensor 7: a missing return.
Sequence merged(const TemporaryFolder& folder) {
  const std::string head =
      "VERSION 0.7\nFIELDS x y z lidar\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 1\n"
      "HEIGHT 1\nWIDTH ";
  folder.write("0.pcd", head + "4\nPOINTS 4\nDATA ascii\n2 0 0 7\n2 0 0 3\n6 0 0 3\n4 0 0 7\n");
  folder.write("1.pcd", head + "3\nPOINTS 3\nDATA ascii\n6 0 0 7\n8 0 0 7\n1 0 0 3\n");
  folder.write("poses.txt", "1 0 0 10 0 1 0 0 0 0 1 0\n1 0 0 20 0 1 0 0 0 0 1 0\n");
  SequenceOptions options;
  options.sensor_origin = parse_sensor_places("lidar:3=0,0,0/7=4,0,0");
  return open_sequence(folder.text(), options);
}

}  // namespace

TEST_CASE("each sensor of a merged cloud has a scan of its own, and masks are those of the cloud",
          "[split]") {
  const TemporaryFolder folder;
  const Sequence sequence = merged(folder);
  auto method = std::make_unique<NearRemover>();
  const NearRemover& remover = *method;
  Masks masks;
  const auto split = with_split_sensors(std::move(method), sequence);
  split->run(*sequence.scans, masks, {});
  // From sensor 7 at x = 4 the points at x = 2, 6 and 8 are 2, 2 and 4 m away; from sensor 3 at
  // x = 0 those at x = 2, 6 and 1 are 2, 6 and 1 m away.
  CHECK(masks.all == std::map<std::size_t, Mask>{{0, {1, 1, 0, 0}}, {1, {1, 0, 1}}});
  REQUIRE(remover.starts.size() == 4);
  const double starts[] = {24.0, 20.0, 14.0, 10.0};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(remover.starts[i].isApprox(Eigen::Vector3d(starts[i], 0.0, 0.0)));
  }
}

TEST_CASE("a second answer for the scan of a sensor is refused", "[split]") {
  const TemporaryFolder folder;
  const Sequence sequence = merged(folder);
  Masks masks;
  const auto twice = with_split_sensors(std::make_unique<NearRemover>(2), sequence);
  CHECK_THROWS_AS(twice->run(*sequence.scans, masks, {}), MethodError);
}

TEST_CASE("a sequence of one sensor is not split", "[split]") {
  auto method = std::make_unique<NearRemover>();
  const Remover* same = method.get();
  CHECK(with_split_sensors(std::move(method), Sequence()).get() == same);
}
