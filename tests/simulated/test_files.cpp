// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/parallel.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/simulation/scene/scene_text.h"
#include "datasets/simulation/scene/simulated.h"
#include "datasets/simulation/sensor/pose_noise.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/simulated/scenes.h"

using namespace raymoval;
using raymoval::simulated::small_town;
using raymoval::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

std::string bytes_of(const Scan& scan) {
  std::string bytes;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    bytes.append(reinterpret_cast<const char*>(scan.points[i].data()), 12);
    bytes.append(reinterpret_cast<const char*>(&scan.reflectance[i]), 4);
  }
  return bytes;
}

std::string hash_of(const SimulatedSequence& sequence, std::size_t index) {
  const Scan scan = sequence.load(index);
  const auto labels = sequence.labels(scan);
  ContentHasher hasher;
  hasher.add(bytes_of(scan));
  hasher.add(labels.data(), labels.size() * 4);
  hasher.add(scan.T_world_sensor.matrix().data(), 16 * sizeof(double));
  return hasher.digest();
}

}  // namespace

TEST_CASE("the same seed gives the same bytes for any threads and any order", "[slow]") {
  for (const std::string sensor : {"vlp16", "solid-state", "rosette"}) {
    SimulationOptions options = small_town(8);
    options.sensor = sensor;
    std::vector<std::string> expected;
    const auto first = make_simulated(options, 1);
    for (std::size_t i = 0; i < first->size(); ++i) expected.push_back(hash_of(*first, i));
    for (const int threads : {1, 2, 8}) {
      const auto other = make_simulated(options, threads);
      std::vector<std::string> found(expected.size());
      parallel_for(threads, found.size(), 1, [&](std::size_t i) {
        const std::size_t backwards = found.size() - 1 - i;
        found[backwards] = hash_of(*other, backwards);
      });
      CHECK(found == expected);
    }
  }
}

TEST_CASE("a scene has the same bytes with every compiler") {
  // Found with GCC 12. Clang evaluates the arguments of a call in the other order.
  CHECK(hash_of(*make_simulated(small_town(1)), 0) == "315c640476ffd08b519ff157b6d64241");
}

TEST_CASE("written files hold what the source gives, in SemanticKITTI's layout") {
  const TemporaryFolder scratch;
  const fs::path folder = scratch / "out";
  write_simulated(small_town(4), folder, 2, nullptr);
  const auto sequence = make_simulated(small_town(4));
  const std::string calib = read_text(folder / "calib.txt");
  const auto row = [](std::string_view line, std::size_t skip) {
    const auto fields = split_blanks(line);
    Pose pose = Pose::Identity();
    for (std::size_t i = 0; i < 12; ++i) {
      pose(static_cast<int>(i / 4), static_cast<int>(i % 4)) =
          parse_number<double>(fields.at(i + skip)).value();
    }
    return pose;
  };
  const Pose Tr = row(std::string_view(calib).substr(calib.find("Tr:")), 1);
  CHECK((Tr.linear() * Tr.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  // The camera's z axis looks along the sensor's x: the transform is not the identity.
  CHECK(Tr(2, 0) > 0.99);
  const std::string poses = read_text(folder / "poses.txt");
  const auto lines = split(poses, '\n');
  REQUIRE(lines.size() == sequence->size() + 1);
  for (std::size_t i = 0; i < sequence->size(); ++i) {
    const Scan scan = sequence->load(i);
    CHECK(read_text(folder / "velodyne" / (scan.name + ".bin")) == bytes_of(scan));
    const auto labels = sequence->labels(scan);
    const std::string words = read_text(folder / "labels" / (scan.name + ".label"));
    REQUIRE(words.size() == 4 * labels.size());
    CHECK(std::memcmp(words.data(), labels.data(), words.size()) == 0);
    const Pose pose = Tr.inverse() * row(lines[i], 0) * Tr;
    CHECK((pose.matrix() - scan.T_world_sensor.matrix()).norm() < 1e-9);
  }
  CHECK(read_text(folder / "times.txt").starts_with("0\n0.1\n0.2"));
  const auto json = read_json(folder / "sequence.json");
  CHECK(json.at("name") == "town");
  CHECK(json.at("sensor") == "vlp16");
  CHECK(json.at("scan_period_s") == 0.1);
  CHECK(read_json(folder / "movers.json").size() == sequence->movers(0).size());
  CHECK(entries_of(scratch.text()).size() == 1);  // no temporary folder is left
  CHECK_THROWS_AS(write_simulated(small_town(4), folder, 1, nullptr), DataError);
}

TEST_CASE("a mover that backs up is written as moving") {
  const TemporaryFolder scratch;
  std::ofstream(scratch / "reverse.json") << R"({
    "roads": [{"name": "a", "points": [[0, 0], [99, 0]]}],
    "ego": {"road": "a", "speed": 5},
    "movers": [{"kind": "car", "road": "a", "start_m": 60, "speed": [[0, -3], [9, -3]]}]})";
  SimulationOptions options = small_town(4);
  options.scene = (scratch / "reverse.json").string();
  write_simulated(options, scratch / "reverse", 1, nullptr);
  const auto movers = read_json(scratch / "reverse" / "movers.json");
  REQUIRE(movers.size() == 1);
  CHECK(movers[0].at("moves") == true);
  CHECK(movers[0].at("when").size() == 1);
  CHECK(movers[0].at("when")[0].at("state") == "moves");
}

TEST_CASE("a scene's name is told without generating it, and is the one it is opened by") {
  const TemporaryFolder scratch;
  setenv("RAYMOVAL_CACHE", scratch.text().c_str(), 1);
  for (const std::string path : {"town:scans=1,sensor=vlp16,seed=4", "street"}) {
    const std::string name = sequence_name(path, {});
    CHECK_FALSE(fs::exists(scratch / "simulated"));
    CHECK(name == path.substr(0, path.find(':')));
    SequenceOptions named;
    named.name = "mine";
    CHECK(sequence_name(path, named) == "mine");
    CHECK(open_sequence(path, {}).name == name);
    fs::remove_all(scratch / "simulated");
  }
  unsetenv("RAYMOVAL_CACHE");
}

TEST_CASE("the cache tells apart whatever changes the bytes", "[slow]") {
  const TemporaryFolder scratch;
  const auto folder = [&](const SimulationOptions& options) {
    return cached_simulation(options, scratch.text(), 2, nullptr);
  };
  SimulationOptions other = small_town(2);
  std::vector<fs::path> folders = {folder(other)};
  other.seed = 9;
  folders.push_back(folder(other));
  other.pose_noise = 0.0;
  folders.push_back(folder(other));
  other.rolling = Rolling::kSkewed;
  folders.push_back(folder(other));
  other.sensor = "solid-state";
  folders.push_back(folder(other));
  other.scans = 3;
  folders.push_back(folder(other));
  other.turned_deg = 30.0;
  folders.push_back(folder(other));
  other.tilted_deg = 30.0;
  other.turned_deg = 0.0;
  folders.push_back(folder(other));
  for (double SimulationOptions::*angle :
       {&SimulationOptions::roll_deg, &SimulationOptions::pitch_deg, &SimulationOptions::yaw_deg}) {
    SimulationOptions turned = other;
    turned.*angle = 30.0;
    folders.push_back(folder(turned));
  }
  std::sort(folders.begin(), folders.end());
  CHECK(std::unique(folders.begin(), folders.end()) == folders.end());
}

TEST_CASE("the cache lies where the environment says") {
  setenv("RAYMOVAL_CACHE", "/somewhere/own", 1);
  CHECK(default_cache_root() == "/somewhere/own");
  unsetenv("RAYMOVAL_CACHE");
  setenv("XDG_CACHE_HOME", "/somewhere/cache", 1);
  CHECK(default_cache_root() == "/somewhere/cache/raymoval");
  unsetenv("XDG_CACHE_HOME");
}

TEST_CASE("scenes and sensors are found by name or path, and names are suggested") {
  const auto message = [](const std::string& scene) {
    SimulationOptions options;
    options.scene = scene;
    try {
      make_simulated(options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(message("toown").find("'town'") != std::string::npos);
  CHECK(message("/nowhere/w.json").find("/nowhere/w.json") != std::string::npos);
  const TemporaryFolder scratch;
  const fs::path own = scratch / "mine.json";
  std::ofstream(own) << simulated_scene_text("town");
  SimulationOptions options = small_town(1);
  options.scene = own.string();
  const auto sequence = make_simulated(options);
  CHECK(sequence->name() == "mine");
  CHECK(hash_of(*sequence, 0) == hash_of(*make_simulated(small_town(1)), 0));
  std::ofstream(own) << "{ \"scans\": 3,\n }";
  CHECK(message(own.string()).find("line 2") != std::string::npos);
}

TEST_CASE("pose errors scale with the severity, wander slowly and stay small") {
  const simulated::PoseNoise noise;
  const auto once = simulated::pose_errors(noise, 1.0, 4000, 0.1, 5);
  const auto twice = simulated::pose_errors(noise, 2.0, 4000, 0.1, 5);
  const auto none = simulated::pose_errors(noise, 0.0, 10, 0.1, 5);
  CHECK(none[7].matrix() == Eigen::Matrix4d::Identity());
  double squares = 0.0;
  double steps = 0.0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    CHECK((twice[i].translation() - 2.0 * once[i].translation()).norm() < 1e-12);
    squares += std::pow(once[i].translation().x(), 2);
    if (i > 0) steps += std::pow(once[i].translation().x() - once[i - 1].translation().x(), 2);
  }
  // 400 s are 40 independent drifts or so: the deviation is known to about 15 %.
  CHECK(std::sqrt(squares / 4000.0) == Approx(0.03).epsilon(0.35));
  // A step is the fresh part of the drift, 0.03 sqrt(2 (1 - exp(-0.02))) = 0.006, and two jitters
  // of 0.005: sqrt(0.006^2 + 2 * 0.005^2) = 0.0093.
  CHECK(std::sqrt(steps / 4000.0) == Approx(0.0093).epsilon(0.1));
}

TEST_CASE("a world with other axes shows the sensor the same") {
  SimulationOptions options = small_town(3);
  const auto usual = make_simulated(options);
  options.turned_deg = 90.0;
  options.tilted_deg = 90.0;
  const auto turned = make_simulated(options);
  CHECK(turned->load(2).points == usual->load(2).points);
  CHECK(turned->labels(turned->load(2)) == usual->labels(usual->load(2)));
  const Eigen::Vector3d at = usual->pose(2).translation();
  // The new x lies along the old y, the new y along the old z, and the new z along the old x.
  const Eigen::Vector3d expected(at.y(), at.z(), at.x());
  CHECK((turned->pose(2).translation() - expected).norm() < 1e-9);
  CHECK((turned->pose(2).linear().col(2) - Eigen::Vector3d::UnitY()).norm() < 0.05);
  CHECK((turned->movers(0.0)[0].T_world_mover.linear().col(2) - Eigen::Vector3d::UnitY()).norm() <
        0.05);
  options.tilted_deg = 400.0;
  CHECK_THROWS_AS(make_simulated(options), UsageError);
}

TEST_CASE("a sensor is turned on its mount, and the world stays") {
  SimulationOptions options = small_town(3);
  options.pose_noise = 0.0;
  const Pose usual = make_simulated(options)->pose(2);
  struct Mount {
    std::string text;
    Eigen::Vector3d x, z;  ///< Axes of the sensor in the vehicle's frame.
  };
  const std::vector<Mount> mounts = {{"roll=90", {1, 0, 0}, {0, -1, 0}},
                                     {"roll=180", {1, 0, 0}, {0, 0, -1}},
                                     {"pitch=90", {0, 0, -1}, {1, 0, 0}},
                                     {"yaw=90", {0, 1, 0}, {0, 0, 1}},
                                     // About x, then y, then z of the vehicle.
                                     {"roll=90,yaw=90", {0, 1, 0}, {1, 0, 0}}};
  for (const auto& [text, x, z] : mounts) {
    INFO(text);
    const SimulationOptions turned =
        parse_scene("town:scans=3,pose_noise=0,sensor=" + options.sensor + "," + text);
    const auto sequence = make_simulated(turned);
    const Scan scan = sequence->load(2);
    CHECK((scan.T_world_sensor.translation() - usual.translation()).norm() < 1e-12);
    const Eigen::Matrix3d turn = usual.linear().transpose() * scan.T_world_sensor.linear();
    CHECK((turn.col(0) - x).norm() < 1e-12);
    CHECK((turn.col(2) - z).norm() < 1e-12);
    // The sensor is 1.73 m above a road that rises and falls by less than half a metre here.
    const std::vector<std::uint32_t> labels = sequence->labels(scan);
    std::size_t road = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (labels[i] != simulated::kLabelRoad || scan.points[i].norm() > 15.0F) continue;
      ++road;
      CHECK((scan.T_world_sensor * scan.points[i].cast<double>()).z() == Approx(-1.73).margin(0.5));
    }
    CHECK(road > 200);
  }
  CHECK_THROWS_AS(parse_scene("town:roll=361"), UsageError);
}
