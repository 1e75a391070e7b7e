// SPDX-License-Identifier: MIT
#include "methods/dynablox/dynablox.h"

#include <catch2/catch.hpp>

#include "tests/methods/moved_world.h"

using namespace raymoval;
using namespace raymoval::dynablox_method;

namespace {

/// A corridor from x = -2 to 14, 4 m wide, its floor 1.6 m below a sensor that stands still and
/// looks ahead.
class Corridor {
 public:
  explicit Corridor(double length = 14.0)
      : boxes_{{{-2, -2, -1.9}, {length, 2, -1.61}},
               {{-2, 2.01, -1.9}, {length, 2.5, 2}},
               {{-2, -2.5, -1.9}, {length, -2.01, 2}},
               {{length, -2.5, -1.9}, {length + 0.5, 2.5, 2}}},
        world(scanner(length)) {}

  /// Scans in which nobody is there.
  void pass(int scans) {
    for (int i = 0; i < scans; ++i) scan(boxes_);
  }
  /// One scan with a person at (x, y): the owner of its points is 4.
  void see_person(double x, double y) {
    std::vector<toy::Box> boxes = boxes_;
    boxes.push_back({{x, y, -1.6}, {x + 0.5, y + 0.5, 0.1}});
    scan(boxes);
  }
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

TEST_CASE("dynablox: nothing moves in a corridor that stands") {
  Corridor corridor;
  corridor.pass(10);
  CHECK(corridor.masks(Parameters{}).removed_count() == 0);
  Parameters offline;
  offline.offline = true;
  CHECK(corridor.masks(offline).removed_count() == 0);
}

TEST_CASE("dynablox: a person moves from the first scan in space that was free for a while") {
  // Seen in scan 0, free in 1 to 5: ever free when scan 6 is judged, and not before.
  Corridor corridor;
  corridor.pass(5);
  for (int i = 0; i < 4; ++i) corridor.see_person(5.0 + 0.3 * i, -0.3);
  const MaskStore masks = corridor.masks(Parameters{});
  CHECK(corridor.share(masks, 5) == 0.0);
  CHECK(corridor.share(masks, 6) > 0.3);  // Where nobody was in scan 5.
  CHECK(corridor.share(masks, 8) > 0.9);
  CHECK(toy::removed_share(corridor.world, masks, 0, 0, 8) < 0.05);
  CHECK(toy::removed_share(corridor.world, masks, 3, 0, 8) == 0.0);
}

TEST_CASE("dynablox: the burn-in says for how long") {
  Parameters parameters;
  parameters.burn_in = 8;
  for (const int before : {8, 9}) {
    Corridor corridor;
    corridor.pass(before);
    corridor.see_person(5.0, -0.3);
    const double share =
        corridor.share(corridor.masks(parameters), static_cast<std::size_t>(before));
    CHECK((before == 9 ? share > 0.9 : share == 0.0));
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
  parameters.max_weight = 1;  // The distance is half that of the last scan.
  parameters.frames_to_reset = 8;
  Corridor corridor;
  corridor.pass(6);
  for (int i = 0; i < 4; ++i) corridor.see_person(5.0, -0.3);
  corridor.pass(6);
  for (int i = 0; i < 3; ++i) corridor.see_person(5.0, -0.3);
  // Occupied in scans 6 to 9, and by the distance, which is only by and by that of free space, in
  // 10, 11 and some in 12: six or seven. In 16 and 17 it is two more, if the break did not count.
  const MaskStore anew = corridor.masks(parameters);
  CHECK(corridor.share(anew, 16) > 0.9);
  CHECK(corridor.share(anew, 18) > 0.9);
  parameters.temporal_buffer = 5;
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

TEST_CASE("dynablox: a far return clears the way, unless it says nothing") {
  Corridor corridor(30.0);
  corridor.pass(6);
  corridor.see_person(15.0, -0.3);
  Parameters parameters;
  CHECK(corridor.share(corridor.masks(parameters), 6) > 0.5);
  parameters.clearing = false;
  CHECK(corridor.share(corridor.masks(parameters), 6) < 0.3);
}

TEST_CASE("dynablox: a cluster must be followed for as long as is asked") {
  Corridor corridor;
  corridor.pass(6);
  for (int i = 0; i < 5; ++i) corridor.see_person(5.0 + 0.2 * i, -0.3);
  Parameters parameters;
  parameters.min_track = 2;
  const MaskStore masks = corridor.masks(parameters);
  CHECK(corridor.share(masks, 7) == 0.0);
  CHECK(corridor.share(masks, 8) > 0.9);
  parameters.track_distance = 0.05;
  CHECK(corridor.masks(parameters).removed_count() == 0);
}

TEST_CASE("dynablox: one scan only") {
  Corridor corridor;
  corridor.see_person(5.0, -0.3);
  Parameters parameters;
  CHECK(corridor.masks(parameters).removed_count() == 0);
  parameters.offline = true;
  CHECK(corridor.masks(parameters).removed_count() == 0);
}

TEST_CASE("dynablox: parameters out of range are refused") {
  for (const auto& [name, text] :
       {std::pair("max_range", "0.5"), std::pair("burn_in", "0"),
        std::pair("free_neighbours", "26"), std::pair("frames_to_reset", "65536")}) {
    const ParameterSpec& spec = find_parameter("dynablox", parameter_table().specs(), name);
    CHECK_THROWS_AS(checked_value_from_text("dynablox", spec, text), ConfigurationError);
  }
}
