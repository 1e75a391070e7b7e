// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

namespace raymoval {

/// What the head of a LAS file says of its values beyond their types: what a LAS file that is made
/// of its points takes over.
struct LasNotes {
  Eigen::Vector3d scale, offset;  ///< Metres: a coordinate is a whole number times scale + offset.
  /// The description (192 bytes) of each field in the extra bytes, by the field's name.
  std::map<std::string, std::string> extra_bytes;
  std::string reference_system;    ///< WKT; empty if there is none.
  bool standard_gps_time = false;  ///< GPS time is adjusted standard time, not of the week.
};

}  // namespace raymoval
