// SPDX-License-Identifier: MIT
// Points of the ego vehicle: they are found, and no method gets them.
#include <numbers>
#include <random>

#include "core/error.h"
#include "datasets/ego/ego_region.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/fingerprint.h"
#include "datasets/reading/left_out.h"
#include "datasets/simulation/scene/simulated.h"
#include "tests/datasets/inspect_data.h"
#include "tests/methods/held_scans.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// A mast left of the sensor and a plate behind it: 60 points that go along with it.
std::vector<Eigen::Vector3f> own_points(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, 0.01F);
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 60; ++k) {
    const float along = static_cast<float>(k % 20) / 20.0F;
    const Eigen::Vector3f place = k < 20 ? Eigen::Vector3f(0.3F, 0.7F, 0.8F * along - 0.4F)
                                         : Eigen::Vector3f(-0.6F - along, 0.6F * float(k > 40), 0);
    points.push_back(place + Eigen::Vector3f(noise(random), noise(random), noise(random)));
  }
  return points;
}

/// `drive` with these points at the end of each scan, labelled 0.
EditedSequence with_own_points(EditedSequence drive, std::size_t count = 60) {
  for (Scan& scan : drive.scans) {
    std::vector<Eigen::Vector3f> own = own_points(static_cast<unsigned>(scan.index));
    own.resize(count);
    scan.points.insert(scan.points.end(), own.begin(), own.end());
    scan.reflectance.resize(scan.size(), 0.5F);
    scan.stored_point_count = scan.size();
    drive.words[scan.index].resize(scan.size(), 0);
  }
  return drive;
}

Sequence sequence_of(const EditedSequence& drive, const std::string& drop) {
  const auto self = std::shared_ptr<const EditedSequence>(&drive, [](const EditedSequence*) {});
  Sequence sequence;
  sequence.name = "drive";
  sequence.layout = "simulated";
  sequence.opened = sequence.scans = std::make_shared<EgoFreeSource>(self, parse_ego_region(drop));
  sequence.labels = self;
  return sequence;
}

}  // namespace

TEST_CASE("a region is a radius or a box, written as it is read", "[ego]") {
  for (const char* text : {"none", "auto", "2.4", "-1:2,-0.9:0.9,-1.5:0.2", ":2,-1:1,:0"}) {
    CHECK(ego_region_text(parse_ego_region(text)) == text);
  }
  const EgoRegion near = parse_ego_region("2.4");
  CHECK(near.contains({0, 2.39, 0}));
  CHECK_FALSE(near.contains({0, 2.4, 0}));
  const EgoRegion box = parse_ego_region(":2,-1:1,-0.5:0");
  CHECK(box.contains({-50, 1, 0}));
  CHECK_FALSE(box.contains({0, 0, 0.01}));
  CHECK_FALSE(box.contains({2.1, 0, -0.1}));
  CHECK_FALSE(parse_ego_region("none").contains({0, 0, 0}));
  for (const char* wrong : {"", "0", "-1", "near", "1:2", "1:0,0:1,0:1", "a:b,0:1,0:1",
                            ":,:,:", "nan", "0:1,0:1,0:1,0:1"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(parse_ego_region(wrong), Catch::Contains("expected auto, none"));
  }
}

TEST_CASE("points of the own vehicle are left out with their labels", "[ego]") {
  const EditedSequence drive = with_own_points(good_drive());
  const Sequence sequence = sequence_of(drive, "-2:0.6,-0.5:1,-1:1");
  const Scan whole = drive.load(3), scan = sequence.scans->load(3);
  REQUIRE(scan.size() == whole.size() - 60);
  CHECK(scan.stored_point_count == whole.size());
  CHECK(scan.reflectance.size() == scan.size());
  for (std::size_t i = 0; i < scan.size(); i += 97) {
    CHECK(scan.points[i] == whole.points[scan.stored_position(i)]);
  }
  const auto lines = left_out_lines(sequence);
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], Catch::Contains("on the ego vehicle (in the box -2:0.6,-0.5:1,-1:1 m)"));
  CHECK(sequence.record().drop_ego.value().left_out == "-2:0.6,-0.5:1,-1:1");
  CHECK(fingerprint(sequence, 1) != fingerprint(sequence_of(drive, "0.01"), 1));
}

TEST_CASE("the own vehicle is found where it goes along with the sensor", "[ego]") {
  const EditedSequence drive = with_own_points(good_drive());
  const Sequence sequence = sequence_of(drive, "auto");
  for (const std::size_t scan : {0U, 7U, 15U}) {
    CHECK(sequence.scans->load(scan).points == good_drive().load(scan).points);
  }
  CHECK(sequence.record().drop_ego.value().asked == "auto");
  CHECK_THAT(left_out_lines(sequence).at(0), Catch::Contains("as estimated"));
}

TEST_CASE("drops of rain around the sensor are no machine", "[ego]") {
  EditedSequence drive = good_drive();
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  for (Scan& scan : drive.scans) {
    // Eight in each cell of 0.25 m, elsewhere in each scan.
    for (int k = 0; k < 2048; ++k) {
      const float x = place(random), y = place(random), z = 0.5F * place(random);
      scan.points.emplace_back(x, y, z);
    }
    scan.reflectance.resize(scan.size(), 0.5F);
    scan.stored_point_count = scan.size();
    drive.words[scan.index].resize(scan.size(), 0);
  }
  const Sequence sequence = sequence_of(drive, "auto");
  CHECK(sequence.scans->load(5).size() == drive.load(5).size());
}

TEST_CASE("where nothing goes along with the sensor nothing is left out", "[ego]") {
  EditedSequence drive = good_drive();
  drive.keep([](const Eigen::Vector3f& point) { return point.norm() > 2.7F; });
  const Sequence sequence = sequence_of(drive, "auto");
  CHECK(sequence.scans->load(5).points == drive.load(5).points);
  CHECK_THAT(left_out_lines(sequence).at(0), Catch::Contains("no points move with the sensor"));
}

TEST_CASE("the ground before a sensor that looks down is no vehicle", "[ego]") {
  // A person walks 16 m; the hand-held sensor is pitched down by 35 degrees and nods a little.
  SimulationOptions options;
  options.scene = "walk";
  options.sensor = "vlp16";
  options.scans = 120;
  const std::shared_ptr<const SimulatedSequence> walk = make_simulated(options);
  const EgoFreeSource scans(walk, parse_ego_region("auto"));
  CHECK(scans.region().kind == EgoRegion::Kind::kNone);
}

TEST_CASE("the floor beside a sensor that lies on its side is no vehicle", "[ego]") {
  SimulationOptions options;
  options.scene = "walk";
  options.sensor = "hdl32e";
  options.scans = 60;
  const auto walk = std::make_shared<toy::ChangedScans>(make_simulated(options), [](Scan& scan) {
    for (Eigen::Vector3f& point : scan.points) point = {point.x(), point.z(), -point.y()};
    scan.T_world_sensor =
        scan.T_world_sensor * Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  });
  CHECK(EgoFreeSource(walk, parse_ego_region("auto")).region().kind == EgoRegion::Kind::kNone);
}

TEST_CASE("a sensor that stands, or a region of everything, is an error", "[ego]") {
  EditedSequence still = with_own_points(good_drive());
  still.each_pose([&](const Pose&) { return still.scans[0].T_world_sensor; });
  const Sequence standing = sequence_of(still, "auto");
  check_says(message_of<DataError>([&] { (void)standing.scans->load(0); }),
             {"only 1 scan a metre or more apart", "--drop-ego RADIUS"});
  const Sequence all = sequence_of(still, "1000");
  check_says(message_of<DataError>([&] { (void)all.scans->load(0); }), {"all of its", "smaller"});
}

TEST_CASE("a sequence says what is left out of it", "[ego]") {
  const TemporaryFolder folder;
  std::string poses;
  for (int k = 0; k < 2; ++k) {
    folder.write("00000" + std::to_string(k) + ".bin",
                 floats({1, 0, 0, 0, 9, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0}));
    folder.write("labels/00000" + std::to_string(k) + ".label", words({1, 2, 3, 4}));
    poses += kIdentityRow;
  }
  folder.write("poses.txt", poses);
  folder.write("sequence.json", R"({"drop_ego": 1.5})");
  const Sequence sequence = open_sequence(folder.text(), {});
  const Scan scan = sequence.scans->load(1);
  CHECK(scan.stored_index == std::vector<std::uint32_t>{1, 2});
  CHECK(sequence.labels->labels(scan) == std::vector<std::uint32_t>{2, 3});
  CHECK(sequence.scans->sensor().range_min > 1.5);
  CHECK(
      left_out_lines(sequence) ==
      std::vector<std::string>{
          "25.0 % of the stored points are missing returns (NaN or at the origin) and are left out",
          "25.0 % of the stored points are on the ego vehicle (nearer than 1.5 m) and are left "
          "out"});
  SequenceOptions options;  // Options replace the file's values.
  options.drop_ego = parse_ego_region("none");
  CHECK(open_sequence(folder.text(), options).scans->load(1).size() == 3);
  CHECK_FALSE(open_sequence(folder.text(), options).record().drop_ego);
  folder.write("sequence.json", R"({"drop_ego": "car"})");
  check_says(message_of<ConfigurationError>([&] { open_sequence(folder.text(), {}); }),
             {"sequence.json: drop_ego", "'car'", "expected auto"});
}

TEST_CASE("the vehicle in view is a finding, or a note where its labels say so",
          "[inspect][slow]") {
  EditedSequence many = with_own_points(good_drive());
  many.range_m.min = 5.0;  // Methods get it for any evaluated range.
  const InspectionReport noted = many.inspected();
  INFO(text_of(noted));
  REQUIRE(noted.findings.size() == 1);
  CHECK(noted.findings[0].check == "ego-vehicle");
  CHECK_THAT(noted.findings[0].what, Catch::Contains("they are labelled as such (0)"));
  CHECK_FALSE(noted.has_findings());
  many.labelled = false;
  check_finds(many.inspected(), "ego-vehicle", "--drop-ego auto, here the box");
  // Eight of some 20,000 points harm no method, see kManyEgoPoints.
  EditedSequence few = with_own_points(good_drive(), 8);
  few.labelled = false;
  check_silent(few.inspected());
}
