// SPDX-License-Identifier: MIT
#include "datasets/ego/sensor_places.h"

#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::optional<Eigen::Vector3d> place_of(std::string_view text) {
  constexpr double kFarthest = 100.0;  // No vehicle is larger than this many metres.
  const auto numbers = parse_numbers(text, ',');
  if (!numbers || numbers->size() != 3) return std::nullopt;
  const Eigen::Vector3d place = Eigen::Map<const Eigen::Vector3d>(numbers->data());
  if (place.cwiseAbs().maxCoeff() > kFarthest) return std::nullopt;
  return place;
}

/// "FIELD:NUMBER=X,Y,Z/NUMBER=X,Y,Z".
std::optional<SensorPlaces> merged_places(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon == 0) return std::nullopt;
  SensorPlaces places;
  places.field = std::string(text.substr(0, colon));
  for (const std::string_view part : split(text.substr(colon + 1), '/')) {
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const auto number = parse_number<std::int64_t>(part.substr(0, equals));
    const auto place = place_of(part.substr(equals + 1));
    if (!number || !place || !places.by_number.emplace(*number, *place).second) {
      return std::nullopt;
    }
  }
  return places;
}

std::string place_text(const Eigen::Vector3d& place) {
  return number_text(place.x()) + "," + number_text(place.y()) + "," + number_text(place.z());
}

}  // namespace

SensorPlaces parse_sensor_places(const std::string& text) {
  if (const auto place = place_of(text)) return *place;
  if (const auto places = merged_places(text)) return *places;
  throw UsageError(
      text +
      ": expected X,Y,Z, the position of the sensor in the frame of the points, up to "
      "100 m, such as 1.2,0,1.8; or, for merged clouds with a field that names the "
      "sensor, one position for each of its numbers: lidar_id:0=1.2,0,1.8/1=-1,0,1.8; or, for "
      "several topics of a recording, one for each: topic:0=1.2,0,1.8/1=-1,0,1.8.");
}

std::string sensor_places_text(const SensorPlaces& places) {
  if (places.field.empty()) return place_text(places.one);
  std::vector<std::string> parts;
  for (const auto& [number, place] : places.by_number) {
    parts.push_back(std::to_string(number) + "=" + place_text(place));
  }
  return places.field + ":" + join(parts, "/");
}

const PointField* find_sensor_field(const RecordLayout& layout) {
  const PointField* field = layout.find({"lidar_id", "sensor_id", "sensor", "lidar", "lidar_index",
                                         "sensor_index", "scanner_id", "scanner", "device_id"});
  return field != nullptr && field->count == 1 ? field : nullptr;
}

std::vector<std::int64_t> sensor_numbers(const RecordSource& records, const Scan& scan,
                                         const std::string& name) {
  const PointRecords stored = records.records(scan.index);
  const PointField* field = stored.layout.find({name});
  if (field == nullptr) {
    std::vector<std::string> names;
    for (const PointField& other : stored.layout.fields) names.push_back(other.name);
    throw DataError(records.place(scan.index) + ": has no field '" + name +
                    "' that names the sensor of a point; found " + join(names) + ".");
  }
  std::vector<std::int64_t> numbers(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    numbers[i] = std::llround(stored.value(scan.stored_position(i), *field));
  }
  return numbers;
}

std::vector<std::size_t> sensor_positions(const RecordSource& records, const Scan& scan,
                                          const SensorPlaces& places) {
  std::vector<std::size_t> positions;
  for (const std::int64_t number : sensor_numbers(records, scan, places.field)) {
    const auto found = places.by_number.find(number);
    if (found == places.by_number.end()) {
      const std::string text = std::to_string(number);
      throw DataError("scan " + scan.name + ": has points of sensor " + text + " (field '" +
                      places.field + "'), expected the numbers that --sensor-origin gives. Add /" +
                      text + "=X,Y,Z to it.");
    }
    positions.push_back(static_cast<std::size_t>(std::distance(places.by_number.begin(), found)));
  }
  return positions;
}

}  // namespace raymoval
