// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/records/record_source.h"

namespace raymoval {

/// The field of places of several topics of a recording, which have their position in --topic as
/// number.
inline constexpr const char* kTopicField = "topic";

/// Where the beams of a scan start, in the frame of its points, metres: one sensor, or several
/// whose clouds were merged and whose numbers stand in a field of the points, or several topics.
struct SensorPlaces {
  SensorPlaces() = default;
  SensorPlaces(const Eigen::Vector3d& place) : one(place) {}  // NOLINT: a place is one sensor.

  Eigen::Vector3d one = Eigen::Vector3d::Zero();
  std::string field = {};                                  ///< Of the merged clouds; else empty.
  std::map<std::int64_t, Eigen::Vector3d> by_number = {};  ///< By the value of `field`.
};

/// "1.2,0,1.8", or "lidar_id:0=1.2,0,1.8/1=-1.2,0,1.8" for merged clouds.
/// @throws UsageError saying what the form is
SensorPlaces parse_sensor_places(const std::string& text);

/// What `parse_sensor_places` reads.
std::string sensor_places_text(const SensorPlaces& places);

/// The field that names the sensor of a point (`lidar_id`, `sensor`, ...), or null.
const PointField* find_sensor_field(const RecordLayout& layout);

/// The number of the sensor of each point of `scan`.
/// @param field name of a field of the records
/// @throws DataError if there is no such field
std::vector<std::int64_t> sensor_numbers(const RecordSource& records, const Scan& scan,
                                         const std::string& field);

/// The sensor of each point of `scan`, as its position among `places.by_number`.
/// @throws DataError as `sensor_numbers`, and if `places` lacks a sensor
std::vector<std::size_t> sensor_positions(const RecordSource& records, const Scan& scan,
                                          const SensorPlaces& places);

}  // namespace raymoval
