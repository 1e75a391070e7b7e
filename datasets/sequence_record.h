// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/label_rule.h"
#include "core/scan/range_limits.h"

namespace raymoval {

/// The region of the ego vehicle whose points are left out, as texts of `ego_region_text`.
struct EgoRecord {
  std::string asked = {};     ///< As the user gave it, "auto".
  std::string left_out = {};  ///< The resulting region.
};

/// How well the poses of a sequence fit its scans: the distance between surfaces of overlapping
/// scans.
struct PoseFitRecord {
  double median_m = 0.0, worst_m = 0.0;
  std::size_t pairs = 0;
};

/// A description of a sequence for results: which data was read, and how. It has no paths.
struct DataRecord {
  std::string name = {};
  std::string layout = {};  ///< "semantickitti".
  std::string source = {};  ///< Free text on origin and licence.
  std::string frames = {};  ///< Range as used, "2350:2670:2".
  std::size_t scans = 0;
  std::string poses = {};         ///< Name of the pose file.
  std::string sensor = {};        ///< Name of the sensor model.
  std::string sensor_basis = {};  ///< Basis of an estimated sensor model; else empty.
  std::string up = {};         ///< Which way is up in the world of the poses. It is empty in files
                               ///< of earlier versions, which took z.
  std::string up_source = {};  ///< Its source, see `up_source_name`.
  std::optional<double> scan_period_s = std::nullopt;
  RangeLimits range_m = {};
  std::optional<EgoRecord> drop_ego = std::nullopt;
  std::optional<LabelRule> label_rule = std::nullopt;  ///< No value if the data has no labels.
  std::string T_sensor = {};       ///< As the user gave it, a file without its folder; else empty.
  std::string sensor_origin = {};  ///< As the user gave it, "1.2,0,1.8"; else empty.
  std::optional<double> time_offset_s = std::nullopt;  ///< As the user gave it.
  /// The times for the correction of motion within scans: "time in seconds from the time of the
  /// scan". Else empty.
  std::string deskew = {};
  /// Missing or unreadable parts of the data, in whole sentences without folders.
  std::vector<std::string> losses = {};
  std::string fingerprint = {};  ///< Hash of all that methods and protocols read; empty if unknown.
};

}  // namespace raymoval
