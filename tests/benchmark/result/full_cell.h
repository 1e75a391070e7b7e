// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/result_fields.h"

namespace raymoval::test {

/// A cell in which every part that may be missing is there.
inline nlohmann::ordered_json full_cell() {
  Cell cell{"town", "comb", "key", CellStatus::kOk, "", ""};
  cell.method = {"comb", "default", "1", true, false, {{"size", 0.5}}};
  DataRecord data{"town",      "files",  "here",      "0:1:1", 2,
                  "poses.txt", "hdl64e", "two scans", "z",     "given"};
  data.scan_period_s = 0.1;
  data.range_m.max = 50.0;
  data.drop_ego = {"auto", "none"};
  data.label_rule = LabelRule{"rule", {252}, {0}};
  data.T_sensor = "0,0,1,0,0,0,1";
  data.losses = {"poses.txt: 1 of 3 scans has no pose."};
  data.time_offset_s = 0.05;
  data.deskew = "t in seconds from the time of the scan";
  data.fingerprint = "f";
  cell.data = data;
  Score score{{"erasor", "erasor", "1", {{"lift", 0.0}}}};
  score.counts = {{"points", 3}};
  score.rates = {{"PR", 90.0}, {"F1", {}, "nothing moves"}};
  score.warnings = {"few points"};
  score.intervals.emplace().rates = {{"PR", 80.0, 95.0}, {"F1", {}, {}, "nothing moves"}};
  cell.scores = {score};
  cell.columns = ColumnRecord{"1", {{"recall", {1, 2}, ""}, {"residue", {0, 0}, "nothing"}}};
  cell.reliability.emplace().bins[9] = {4, 3, 950};
  cell.masks = MaskRecord{"d", 7};
  cell.measured = {1, 0.1, 0.1, 0.2, 1.0, 0.5, {{"cast", 0.3}}, 90.0};
  return nlohmann::ordered_json::parse(to_json(cell).dump());
}

}  // namespace raymoval::test
