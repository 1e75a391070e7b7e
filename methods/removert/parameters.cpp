// SPDX-License-Identifier: MIT
#include "methods/removert/parameters.h"

namespace raymoval::removert_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kOurs = "not in the paper";
constexpr const char* kCode = "public code";
constexpr const char* kList = "KITTI settings of the ROS-free port";
constexpr const char* kRevertList = "paper, RM3+RV1 (0.55 deg, unverified)";
constexpr const char* kUnit = "px/deg";

void add_passes(Table& table) {
  table
      .number("remove_resolution_1", &P::remove_resolution_1,
              {kUnit, 0, 20, kList, "Pixels per degree of the first remove pass; 0: no pass."})
      .number("remove_resolution_2", &P::remove_resolution_2,
              {kUnit, 0, 20, kList,
               "Pixels per degree of the second remove pass, usually fewer than of the first; 0: "
               "no pass."})
      .number("remove_resolution_3", &P::remove_resolution_3,
              {kUnit, 0, 20, kList, "Pixels per degree of the third remove pass; 0: no pass."})
      .number("revert_resolution_1", &P::revert_resolution_1,
              {kUnit, 0, 20, kRevertList,
               "Pixels per degree of the first revert pass, below the last remove pass's; 0: no "
               "pass. With fewer pixels more points come back."});
}

void add_test(Table& table) {
  table
      .number("gamma", &P::gamma,
              {"", 0, 0.99, kCode,
               "A map point is dynamic if it is nearer than the scan's return by more than this "
               "share of the return's range."})
      .number("diff_upper", &P::diff_upper,
              {"m", 0, 9999, kCode, "Differences from this on are not believed."})
      .choice("difference", &P::difference,
              {{"signed", DifferenceRule::kSigned}, {"absolute", DifferenceRule::kAbsolute}},
              {.source = "lt-mapper (signed), public code (absolute)",
               .sentence = "Whether map points behind the scan's return are dynamic too "
                           "(absolute)."});
}

void add_image(Table& table) {
  table
      .number("vertical_fov", &P::vertical_fov,
              {"deg", 1, 180, kCode, "Height of the images, half of it above the horizon."})
      .number("horizontal_fov", &P::horizontal_fov,
              {"deg", 1, 360, kCode, "Width of the images, half of it to the left."})
      .flag("clamp_fov", &P::clamp_fov,
            {.source = kCode,
             .sentence = "Put points outside the field of view into the border pixels instead of "
                         "leaving them out."})
      .flag("wrap_azimuth", &P::wrap_azimuth,
            {.source = kOurs,
             .sentence = "In a full circle, join the half column right of -180 deg and the one "
                         "left of +180 deg.",
             .acts_when = "horizontal_fov is 360"});
}

void add_update(Table& table) {
  table.flag(
      "update_between_passes", &P::update_between_passes,
      {.source = kCode,
       .sentence = "Take flagged points out of the map before the next pass, so that it sees "
                   "what they hid; the ROS-free port does not."});
}

void add_data(Table& table) {
  table.number("map_voxel", &P::map_voxel,
               {"m", 0.01, 2, kCode, "Edge of the cells whose centroids are the map."});
}

}  // namespace

std::vector<double> Parameters::remove_resolutions() const {
  std::vector<double> resolutions = {remove_resolution_1, remove_resolution_2, remove_resolution_3};
  std::erase(resolutions, 0.0);
  return resolutions;
}

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = [] {
    Table t;
    add_passes(t);
    add_test(t);
    add_image(t);
    add_update(t);
    add_data(t);
    return t;
  }();
  return table;
}

}  // namespace raymoval::removert_method
