// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/label_rule.h"
#include "core/scan/range_limits.h"

namespace raymoval {

/// The region of the own vehicle whose points are left out, as texts of `ego_region_text`.
struct EgoRecord {
  std::string asked = {};     ///< What the user asked for, "auto".
  std::string left_out = {};  ///< What is left out for it.
};

/// How well the poses of a sequence fit its scans: the distance between surfaces of overlapping
/// scans.
struct PoseFitRecord {
  double median_m = 0.0, worst_m = 0.0;
  std::size_t pairs = 0;
};

/// What was read of a sequence and how. It has no path, because it is stored with results.
struct DataRecord {
  std::string name = {};
  std::string layout = {};  ///< "semantickitti".
  std::string source = {};  ///< Free text on origin and licence.
  std::string frames = {};  ///< Range as used, "2350:2670:2".
  std::size_t scans = 0;
  std::string poses = {};         ///< Name of the pose file.
  std::string sensor = {};        ///< Name of the sensor model.
  std::string sensor_basis = {};  ///< What an estimated sensor model rests on; else empty.
  std::string up = {};         ///< Which way is up in the world of the poses. It is empty in files
                               ///< of earlier versions, which took z.
  std::string up_source = {};  ///< How that is known.
  std::optional<double> scan_period_s = std::nullopt;
  RangeLimits range_m = {};
  std::optional<EgoRecord> drop_ego = std::nullopt;
  std::optional<LabelRule> label_rule = std::nullopt;  ///< No value if the data has no labels.
  std::string T_sensor = {};       ///< As the user said it, a file without its folder; else empty.
  std::string sensor_origin = {};  ///< As the user said it, "1.2,0,1.8"; else empty.
  std::optional<double> time_offset_s = std::nullopt;  ///< As the user said it.
  /// How motion within scans was taken out: "time in seconds from the time of the scan". Else
  /// empty.
  std::string deskew = {};
  /// What of the data is missing or could not be read, in whole sentences without folders.
  std::vector<std::string> losses = {};
  std::string fingerprint = {};  ///< Hash of all that methods and protocols read; empty if unknown.
};

}  // namespace raymoval
