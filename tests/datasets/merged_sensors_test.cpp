// SPDX-License-Identifier: MIT
// Clouds of two sensors that were merged in the frame of a vehicle.
#include "core/error.h"
#include "core/text.h"
#include "datasets/ego/sensor_places.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/inspect_data.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// The sensors stand 1.5 m above the origin of the vehicle, the second one 2 m ahead of the first.
const Eigen::Vector3d kFirst(0.0, 0.0, 1.5), kSecond(2.0, 0.0, 1.5);

/// Writes the street of 50 scans, 1 m apart: scan i of the first sensor and scan i + 2, which is
/// what the second sensor sees at that time, the second sensor's points first.
void write_merged(const TemporaryFolder& folder, bool with_field) {
  const Sequence street = make_street({}, street_boxes());
  std::string poses;
  for (std::size_t i = 0; i + 2 < street.scans->size(); ++i) {
    const Scan first = street.scans->load(i);
    std::vector<float> values;
    std::size_t points = 0;
    for (const int sensor : {1, 0}) {
      const Scan scan = sensor == 0 ? first : street.scans->load(i + 2);
      const Eigen::Vector3d place = sensor == 0 ? kFirst : kSecond;
      for (const Eigen::Vector3f& point : scan.points) {
        const Eigen::Vector3f p = point + place.cast<float>();
        values.insert(values.end(), {p.x(), p.y(), p.z()});
        if (with_field) values.push_back(static_cast<float>(sensor));
      }
      points += scan.size();
    }
    const std::string count = std::to_string(points);
    const std::string ones = with_field ? " 1 1 1 1" : " 1 1 1";
    folder.write(first.name + ".pcd",
                 std::string("VERSION 0.7\nFIELDS x y z") + (with_field ? " lidar_id" : "") +
                     "\nSIZE" + (with_field ? " 4 4 4 4" : " 4 4 4") + "\nTYPE" +
                     (with_field ? " F F F F" : " F F F") + "\nCOUNT" + ones + "\nWIDTH " + count +
                     "\nHEIGHT 1\nPOINTS " + count + "\nDATA binary\n" + floats(values));
    const Eigen::Vector3d t = first.T_world_sensor.translation() - kFirst;
    poses += "1 0 0 " + number_text(t.x()) + " 0 1 0 " + number_text(t.y()) + " 0 0 1 " +
             number_text(t.z()) + "\n";
  }
  folder.write("poses.txt", poses);
}

}  // namespace

TEST_CASE("merged clouds whose points name their sensor are found, with the place of each",
          "[inspect][slow]") {
  const TemporaryFolder folder;
  write_merged(folder, true);
  const InspectionReport report = inspect_path(folder.text(), {});
  check_finds(report, "beams-start-elsewhere", "--sensor-origin lidar_id:0=");
  const std::string& remedy = report.findings[0].remedy;
  const std::string text = remedy.substr(remedy.rfind(' ') + 1);
  const SensorPlaces advised = parse_sensor_places(text.substr(0, text.size() - 1));
  REQUIRE(advised.by_number.size() == 2);
  CHECK((advised.by_number.at(0) - kFirst).norm() < 0.15);
  CHECK((advised.by_number.at(1) - kSecond).norm() < 0.15);

  SequenceOptions options;
  options.sensor_origin = advised;
  check_silent(inspect_path(folder.text(), options));
  CHECK(open_sequence(folder.text(), options).record().sensor_origin ==
        sensor_places_text(advised));
}

TEST_CASE("merged clouds whose points name no sensor are named", "[inspect][slow]") {
  const TemporaryFolder folder;
  write_merged(folder, false);
  const InspectionReport report = inspect_path(folder.text(), {});
  CHECK(found(report).count("merged-sensors") == 1);
}

TEST_CASE("places of sensors are read as they are written, and faults are named", "[inspect]") {
  const std::string text = "lidar_id:-1=1.5,0,2/4=0,-0.25,1";
  const SensorPlaces places = parse_sensor_places(text);
  CHECK(places.field == "lidar_id");
  CHECK(places.by_number.at(-1) == Eigen::Vector3d(1.5, 0.0, 2.0));
  CHECK(sensor_places_text(places) == text);
  for (const char* wrong : {":0=1,2,3", "id:", "id:0", "id:0=1,2", "id:0=1,2,3/0=1,2,3",
                            "id:a=1,2,3", "id:0=1,2,300"}) {
    INFO(wrong);
    CHECK_THROWS_AS(parse_sensor_places(wrong), UsageError);
  }
  const TemporaryFolder folder;
  write_merged(folder, true);
  SequenceOptions options;
  options.sensor_origin = parse_sensor_places("lidar_id:0=0,0,1.5");
  CHECK_THROWS_WITH(open_sequence(folder.text(), options), Catch::Contains("Add /1=X,Y,Z to it."));
  options.sensor_origin = parse_sensor_places("sensor:0=0,0,1.5/1=2,0,1.5");
  CHECK_THROWS_WITH(open_sequence(folder.text(), options),
                    Catch::Contains("found x, y, z, lidar_id"));
}
