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
// When parameters act.
constexpr const char* kScore = "decision is score";
constexpr const char* kScanSide = "scan_side is true";

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
      .number("remove_resolution_4", &P::remove_resolution_4,
              {kUnit, 0, 20, kOurs, "Pixels per degree of a fourth remove pass; 0: no pass."})
      .number("revert_resolution_1", &P::revert_resolution_1,
              {kUnit, 0, 20, kRevertList,
               "Pixels per degree of the first revert pass, below the last remove pass's; 0: no "
               "pass. With fewer pixels more points come back."})
      .number("revert_resolution_2", &P::revert_resolution_2,
              {kUnit, 0, 20, kCode, "Pixels per degree of a second revert pass; 0: no pass."})
      .number("revert_resolution_3", &P::revert_resolution_3,
              {kUnit, 0, 20, kCode, "Pixels per degree of a third revert pass; 0: no pass."})
      .number("revert_resolution_4", &P::revert_resolution_4,
              {kUnit, 0, 20, kCode, "Pixels per degree of a fourth revert pass; 0: no pass."});
}

void add_test(Table& table) {
  table
      .number("gamma", &P::gamma,
              {"", 0, 0.99, kCode,
               "A map point is dynamic if it is nearer than the scan's return by more than this "
               "share of the return's range."})
      .number("tau_abs", &P::tau_abs,
              {"m", 0, 100, "lt-mapper (0.1, instead of gamma)", "Least value of that margin."})
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
             .acts_when = "horizontal_fov is 360"})
      .flag("world_axes", &P::world_axes,
            {.source = "ROS-free port",
             .sentence = "Images along the world's axes instead of the sensor's."});
}

void add_decision(Table& table) {
  table
      .choice("decision", &P::decision,
              {{"any", DecisionRule::kAny}, {"score", DecisionRule::kScore}},
              {.source = "public code (any), its design note (score)",
               .sentence = "Whether one scan removes a map point, or weighed counts of scans do."})
      .number(
          "static_weight", &P::static_weight,
          {"", 0, 100, "design note, alpha_SM", "Weight of a scan that sees the point.", kScore})
      .number(
          "dynamic_weight", &P::dynamic_weight,
          {"", 0, 100, "design note, alpha_DM", "Weight of a scan that sees through it.", kScore})
      .number("static_score", &P::static_score,
              {"", -1e6, 1e6, "design note, tau_S",
               "A point with a smaller score is dynamic (decision = score).", kScore})
      .flag("update_between_passes", &P::update_between_passes,
            {.source = kCode,
             .sentence = "Take flagged points out of the map before the next pass, so that it sees "
                         "what they hid; the ROS-free port does not."})
      .flag("revert_needs_view", &P::revert_needs_view,
            {.source = kOurs,
             .sentence = "Restore only points that a scan sees as the nearest in their pixel.",
             .acts_when =
                 "revert_resolution_1 > 0 or revert_resolution_2 > 0 or revert_resolution_3 > 0 or "
                 "revert_resolution_4 > 0"});
}

void add_data(Table& table) {
  table
      .number("map_voxel", &P::map_voxel,
              {"m", 0, 2, kCode,
               "Edge of the cells whose centroids are the map, at least 0.01; 0 keeps every point "
               "and with it memory for the whole input."})
      .number("scan_voxel", &P::scan_voxel,
              {"m", 0, 2, "public code (0.05, without effect on large scans)",
               "Edge of the cells whose centroids stand for a scan; 0 keeps its points."})
      .integer("keyframe_gap", &P::keyframe_gap,
               {"scans", 1, 1000, "public code (5)", "Every so many scans are used."})
      .integer("batch_scans", &P::batch_scans,
               {"scans", 0, 1000000, "public code (advice: below 100)",
                "Scans cleaned together, with a map of their own; 0: all."})
      .flag("scan_side", &P::scan_side,
            {.source = "public code, not in the paper",
             .sentence = "Answer by distances to neighbours in the static map and in the scan "
                         "instead of by membership in a removed cell."})
      .integer("scan_side_neighbours", &P::scan_side_neighbours,
               {"points", 1, 100, kCode, "Neighbours k of the scan-side step, the point included.",
                kScanSide})
      .number("scan_side_threshold", &P::scan_side_threshold,
              {"m^2", 0, 100, kCode,
               "Static if the mean square distances differ by less than this.", kScanSide});
}

std::vector<double> positive(std::initializer_list<double> resolutions) {
  std::vector<double> kept;
  for (const double resolution : resolutions) {
    if (resolution > 0.0) kept.push_back(resolution);
  }
  return kept;
}

}  // namespace

std::vector<double> Parameters::remove_resolutions() const {
  return positive(
      {remove_resolution_1, remove_resolution_2, remove_resolution_3, remove_resolution_4});
}

std::vector<double> Parameters::revert_resolutions() const {
  return positive(
      {revert_resolution_1, revert_resolution_2, revert_resolution_3, revert_resolution_4});
}

const ParameterTable<Parameters>& parameter_table() {
  static const Table table = [] {
    Table t;
    add_passes(t);
    add_test(t);
    add_image(t);
    add_decision(t);
    add_data(t);
    return t;
  }();
  return table;
}

}  // namespace raymoval::removert_method
