// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "datasets/simulation/sensor/sensor_file.h"
#include "datasets/simulation/world/world_file.h"

namespace raymoval::simulated {

/// A data file built into the library.
struct BuiltInFile {
  std::string_view name;  ///< Without folder and ".json".
  std::string_view text;
};
/// Sorted by name. Defined by a source file that the build makes from worlds/ and sensors/.
const std::vector<BuiltInFile>& built_in_worlds();
const std::vector<BuiltInFile>& built_in_sensors();

/// Name and text of a file: `name_or_path` is a path if it ends in ".json".
struct NamedText {
  std::string name;
  std::string text;
  std::string file;  ///< For messages: the path as given, or NAME.json of a built-in file.
};
NamedText find_world(const std::string& name_or_path);
NamedText find_sensor(const std::string& name_or_path);

WorldFile parse_world(const NamedText& file);
SensorFile parse_sensor(const NamedText& file);

}  // namespace raymoval::simulated
