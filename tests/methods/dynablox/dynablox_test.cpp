// SPDX-License-Identifier: MIT
#include "methods/dynablox/dynablox.h"

#include <catch2/catch.hpp>

#include "tests/methods/moved_world.h"

namespace raymoval::dynablox_test {
using namespace raymoval::dynablox_method;

namespace {

/// A corridor from x = -2 to 14, 4 m wide, its floor 1.6 m below a stationary sensor that faces
/// ahead.
class Corridor {
 public:
  explicit Corridor(double length = 14.0)
      : boxes_{{{-2, -2, -1.9}, {length, 2, -1.61}},
               {{-2, 2.01, -1.9}, {length, 2.5, 2}},
               {{-2, -2.5, -1.9}, {length, -2.01, 2}},
               {{length, -2.5, -1.9}, {length + 0.5, 2.5, 2}}},
        world(scanner(length)) {}

  /// Scans without a person.
  void pass(int scans) {
    for (int i = 0; i < scans; ++i) scan(boxes_);
  }
  /// One scan with something more there: the owner of its points is 4.
  void see(const toy::Box& box) {
    std::vector<toy::Box> boxes = boxes_;
    boxes.push_back(box);
    scan(boxes);
  }
  /// One scan with a person at (x, y).
  void see_person(double x, double y) { see({{x, y, -1.6}, {x + 0.5, y + 0.5, 0.1}}); }
  /// Later scans are from this far into the corridor.
  void go_to(double x) { sensor_at_ = x; }
  /// The share of the person's points that is removed from scan `i`.
  [[nodiscard]] double share(const MaskStore& masks, std::size_t i) const {
    return toy::removed_share(world, masks, 4, i, i);
  }
  [[nodiscard]] MaskStore masks(const Parameters& parameters) const {
    return toy::masks_of(*make_dynablox(parameters), world);
  }

 private:
  static toy::Scanner scanner(double length) {
    toy::Scanner scanner;
    scanner.azimuth_from = -20;
    scanner.azimuth_to = 20;
    scanner.range = length + 5.0;
    return scanner;
  }
  void scan(const std::vector<toy::Box>& boxes) {
    world.scan(boxes, Pose(Eigen::Translation3d(sensor_at_ + 0.07, 0.03, 0.05)));
  }

  std::vector<toy::Box> boxes_;
  double sensor_at_ = 0.0;

 public:
  toy::World world;
};

}  // namespace

TEST_CASE("dynablox: nothing moves in a corridor that stands") {
  Corridor corridor;
  corridor.pass(10);
  CHECK(corridor.masks(Parameters{}).removed_count() == 0);
  Parameters offline;
  offline.offline = true;
  CHECK(corridor.masks(offline).removed_count() == 0);
}

TEST_CASE("dynablox: a person moves from the first scan in space that was free for a while") {
  // Free in scans 0 to 4, five of them: ever free when scan 5 is judged, and not before.
  Corridor corridor;
  corridor.pass(4);
  for (int i = 0; i < 4; ++i) corridor.see_person(5.0 + 0.3 * i, -0.3);
  const MaskStore masks = corridor.masks(Parameters{});
  CHECK(corridor.share(masks, 4) == 0.0);
  CHECK(corridor.share(masks, 5) > 0.3);  // No person was there in scan 4.
  CHECK(corridor.share(masks, 7) > 0.9);
  CHECK(toy::removed_share(corridor.world, masks, 0, 0, 7) < 0.05);
  CHECK(toy::removed_share(corridor.world, masks, 3, 0, 7) == 0.0);
}

TEST_CASE("dynablox: what is first seen later was never occupied") {
  // A curtain at 3 m in scans 0 to 7. Scan 8 shows free space behind it, which is evaluated after
  // scan 9 is judged: ever free at once.
  const auto share_in = [](int scan) {
    Corridor corridor;
    for (int i = 0; i < 8; ++i) corridor.see({{3.0, -2.0, -1.6}, {3.3, 2.0, 2.0}});
    corridor.pass(scan - 8);
    corridor.see_person(8.0, -0.3);
    return corridor.share(corridor.masks(Parameters{}), static_cast<std::size_t>(scan));
  };
  CHECK(share_in(9) == 0.0);
  CHECK(share_in(10) > 0.5);
}

TEST_CASE("dynablox: the burn-in says for how long") {
  Parameters parameters;
  parameters.burn_in = 8;
  for (const int before : {7, 8}) {
    Corridor corridor;
    corridor.pass(before);
    corridor.see_person(5.0, -0.3);
    const double share =
        corridor.share(corridor.masks(parameters), static_cast<std::size_t>(before));
    CHECK((before == 8 ? share > 0.9 : share == 0.0));
  }
}

TEST_CASE("dynablox: what stays long enough is no longer taken for moving") {
  Corridor corridor;
  corridor.pass(6);
  // There from scan 6 on; in scan 15 for the tenth time, after which the space is no longer free.
  for (int i = 0; i < 12; ++i) corridor.see_person(5.0, -0.3);
  Parameters parameters;
  parameters.frames_to_reset = 10;
  const MaskStore masks = corridor.masks(parameters);
  CHECK(corridor.share(masks, 6) > 0.9);
  CHECK(corridor.share(masks, 15) > 0.9);
  CHECK(corridor.share(masks, 16) == 0.0);
  CHECK(corridor.share(masks, 17) == 0.0);
  parameters.frames_to_reset = 150;
  CHECK(corridor.share(corridor.masks(parameters), 17) > 0.9);
}

TEST_CASE("dynablox: after a longer break the count of scans begins anew") {
  Parameters parameters;
  parameters.max_weight = 1;  // The distance is nearly that of the last scan.
  parameters.frames_to_reset = 7;
  Corridor corridor;
  corridor.pass(6);
  for (int i = 0; i < 4; ++i) corridor.see_person(5.0, -0.3);
  corridor.pass(6);
  for (int i = 0; i < 3; ++i) corridor.see_person(5.0, -0.3);
  // Occupied in scans 6 to 9, and by the distance in 10: five. In 16 and 17 it is two more, if the
  // break did not count.
  const MaskStore anew = corridor.masks(parameters);
  CHECK(corridor.share(anew, 16) > 0.9);
  CHECK(corridor.share(anew, 18) > 0.9);
  parameters.temporal_buffer = 6;
  const MaskStore on = corridor.masks(parameters);
  CHECK(corridor.share(on, 16) > 0.9);
  CHECK(corridor.share(on, 18) == 0.0);
}

TEST_CASE("dynablox: what appears where nobody has looked does not move") {
  Corridor corridor;
  // Always behind the person in front.
  std::vector<double> shares;
  for (int i = 0; i < 8; ++i) corridor.see_person(3.0, -0.3);
  corridor.see_person(6.0, -0.3);
  const MaskStore masks = corridor.masks(Parameters{});
  CHECK(corridor.share(masks, 8) < 0.3);
}

TEST_CASE("dynablox: all is judged in the end, whatever the range and before it was free") {
  Corridor corridor;
  for (int i = 0; i < 3; ++i) corridor.see_person(5.0 + 0.6 * i, -0.3);
  corridor.pass(40);  // The mean of distances needs a while to forget the person.
  Parameters parameters;
  CHECK(corridor.masks(parameters).removed_count() == 0);
  parameters.offline = true;
  const MaskStore masks = corridor.masks(parameters);
  for (std::size_t i = 0; i < 3; ++i) CHECK(corridor.share(masks, i) > 0.7);
  CHECK(toy::removed_share(corridor.world, masks, 3, 0, 42) == 0.0);
}

TEST_CASE("dynablox: nothing takes part beyond the range") {
  Corridor corridor(30.0);
  corridor.pass(6);
  corridor.see_person(22.0, -0.3);
  Parameters parameters;
  CHECK(corridor.masks(parameters).removed_count() == 0);
  parameters.max_range = 80.0;  // The sensor's own range is 35 m.
  CHECK(corridor.share(corridor.masks(parameters), 6) > 0.5);
}

TEST_CASE("dynablox: a far return clears the way") {
  Corridor corridor(30.0);
  corridor.pass(6);
  corridor.see_person(15.0, -0.3);
  CHECK(corridor.share(corridor.masks(Parameters{}), 6) > 0.5);
}

TEST_CASE("dynablox: points beyond the range are judged by what was seen from nearby") {
  Corridor corridor(30.0);
  corridor.go_to(10.0);
  corridor.pass(6);
  corridor.go_to(0.0);
  corridor.see_person(22.0, -0.3);
  CHECK(corridor.share(corridor.masks(Parameters{}), 6) > 0.5);
}

TEST_CASE("dynablox: one scan only") {
  Corridor corridor;
  corridor.see_person(5.0, -0.3);
  Parameters parameters;
  CHECK(corridor.masks(parameters).removed_count() == 0);
  parameters.offline = true;
  CHECK(corridor.masks(parameters).removed_count() == 0);
}

TEST_CASE("dynablox: parameters that leave nothing free are refused") {
  Parameters ranges;
  ranges.min_range = ranges.max_range;
  CHECK_THROWS_WITH(make_dynablox(ranges),
                    Catch::Contains("min_range = 20") && Catch::Contains("raise max_range"));
  ranges.min_range = 19.9;
  CHECK_NOTHROW(make_dynablox(ranges));
  Parameters distances;
  distances.truncation = distances.occupied_below;
  CHECK_THROWS_WITH(make_dynablox(distances),
                    Catch::Contains("truncation = 0.3") && Catch::Contains("lower occupied_below"));
  distances.truncation = 0.31;
  CHECK_NOTHROW(make_dynablox(distances));
}

}  // namespace raymoval::dynablox_test
