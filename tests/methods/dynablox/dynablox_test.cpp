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
    world.scan(boxes, Pose(Eigen::Translation3d(0.07, 0.03, 0.05)));
  }

  std::vector<toy::Box> boxes_;

 public:
  toy::World world;
};

}  // namespace

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

TEST_CASE("dynablox: what appears where nobody has looked does not move") {
  Corridor corridor;
  // Always behind the person in front.
  std::vector<double> shares;
  for (int i = 0; i < 8; ++i) corridor.see_person(3.0, -0.3);
  corridor.see_person(6.0, -0.3);
  const MaskStore masks = corridor.masks(Parameters{});
  CHECK(corridor.share(masks, 8) < 0.3);
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
