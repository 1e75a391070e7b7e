// SPDX-License-Identifier: MIT
#include "methods/removert/removert.h"

namespace raymoval {
namespace removert_method {
namespace {

using Table = ParameterTable<Parameters>;
using P = Parameters;
constexpr const char* kOurs = "not in the paper";
constexpr const char* kCode = "public code";
constexpr const char* kList = "KITTI settings of the ROS-free port";
constexpr const char* kRevertList = "paper, RM3+RV1 (0.55 deg, unverified)";
constexpr const char* kUnit = "px/deg";

void add_passes_and_test(Table& table) {
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
               "pass. Fewer pixels restore more points."})
      .number("gamma", &P::gamma,
              {"", 0, 0.99, kCode,
               "A map point is dynamic if it is nearer than the scan's return by more than this "
               "share of the return's range."})
      .number("diff_upper", &P::diff_upper,
              {"m", 0, 9999, kCode, "Larger differences of range are ignored."})
      .choice("difference", &P::difference,
              {{"signed", DifferenceRule::kSigned}, {"absolute", DifferenceRule::kAbsolute}},
              {.source = "lt-mapper (signed), public code (absolute)",
               .sentence = "Whether map points behind the scan's return are dynamic too "
                           "(absolute)."});
}

void add_image_and_map(Table& table) {
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
             .acts_when = "horizontal_fov is 360"})
      .flag("update_between_passes", &P::update_between_passes,
            {.source = kCode,
             .sentence = "Remove flagged points from the map before the next pass, which then uses "
                         "the points behind them; the ROS-free port does not."})
      .number("map_voxel", &P::map_voxel,
              {"m", 0.01, 2, kCode, "Edge of the cells whose centroids form the map."});
}

Table make_table() {
  Table table;
  add_passes_and_test(table);
  add_image_and_map(table);
  return table;
}

}  // namespace
}  // namespace removert_method

namespace {

/// The values that the public code and its port share.
Configuration removert_code() {
  return {{"difference", std::string("absolute")}, {"clamp_fov", true}, {"wrap_azimuth", false}};
}

Configuration removert_with(Configuration base, const Configuration& more) {
  base.insert(base.end(), more.begin(), more.end());
  return base;
}

/// The first is the default.
std::vector<MethodVariant> removert_variants() {
  const Configuration code = removert_code();
  return {
      {.name = "rm3", .sentence = "Three remove passes."},
      {.name = "rm3-rv1",
       .sentence = "Three remove passes and one revert pass (RM3+RV1; a '+' cannot name a result).",
       .overrides = {{"revert_resolution_1", 1.8182}}},
      {.name = "code",
       .sentence = "The results of the public code, including its errors.",
       .overrides =
           removert_with(code, {{"remove_resolution_2", 2.0}, {"remove_resolution_3", 1.5}})},
      {.name = "port",
       .sentence = "The results of the ROS-free port with images along the sensor's axes; it tests "
                   "the same map in every pass.",
       .overrides = removert_with(code, {{"update_between_passes", false}})},
  };
}

}  // namespace

MethodEntry removert_entry() {
  MethodEntry entry;
  entry.name = "removert";
  entry.sentence =
      "Compares range images of map and scan: removes map points that a scan sees through, then "
      "restores those that coarser images do not confirm.";
  entry.source =
      "Kim and Kim, Remove, then Revert: Static Point cloud Map Construction using "
      "Multiresolution Range Images, IROS 2020";
  entry.bibtex = R"(@inproceedings{kim2020removert,
  author = {Kim, Giseop and Kim, Ayoung},
  title = {Remove, then Revert: Static Point cloud Map Construction using Multiresolution Range
    Images},
  booktitle = {IEEE/RSJ International Conference on Intelligent Robots and Systems (IROS)},
  year = {2020},
  pages = {10758--10765},
  doi = {10.1109/IROS45743.2020.9340856}
}
)";
  entry.notes = {
      "Written from a description of the method; nothing of the public code is in it.",
      "The difference is signed, as in the author's later lt-mapper; the public code takes its "
      "absolute value and so also removes points behind a return.",
      "Points outside the vertical field of view are in no pixel; the public code puts them into "
      "the border rows.",
      "The public code's revert is empty; here, as in lt-mapper, the removed points alone are "
      "compared with all scans at coarser pixels and are restored unless flagged, with the same "
      "relative margin as in the remove passes.",
      "RM3's resolutions are those of the ROS-free port, which attributes them to the published "
      "comparison; RV1's 0.55 degrees is unverified.",
      "A single scan removes a map point.",
      "The map's cells lie on the lattice at the world's origin, and a point is removed iff its "
      "cell is; the public code's lattice depends on the cloud, and its points get the verdict of "
      "the nearest neighbour.",
      "Scans are not thinned: the public code's filter returns its input on scans of this size.",
      "No KD-tree ball and no empty-pixel value: every map point is compared, and an empty pixel "
      "is empty.",
  };
  entry.variants = removert_variants();
  entry.bind(removert_method::make_table(), removert_method::make_removert);
  return entry;
}

}  // namespace raymoval
