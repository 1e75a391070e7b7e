// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/parallel.h"
#include "core/scan/sensor_model.h"
#include "core/text.h"
#include "datasets/simulation/scene/making_place.h"
#include "datasets/simulation/scene/scene_folder.h"
#include "datasets/simulation/scene/scene_writer.h"
#include "datasets/simulation/scene/simulated.h"

static_assert(std::endian::native == std::endian::little, "files hold little-endian numbers");

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// T_camera_lidar of a car like KITTI's: the camera looks ahead, 27 cm before and 8 cm below the
/// sensor, and is not mounted quite straight.
Pose camera_from_lidar() {
  Pose Tr = Pose::Identity();
  Eigen::Matrix3d axes;
  axes << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Eigen::Vector3d small(0.0075, -0.0148, 0.0021);  // radians
  const Eigen::AngleAxisd tilt(small.norm(), small.normalized());
  Tr.linear() = tilt.toRotationMatrix() * axes;
  Tr.translation() = Eigen::Vector3d(-0.004, -0.076, -0.272);
  return Tr;
}

std::string row_text(const Pose& pose) {
  std::string text;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) text += (text.empty() ? "" : " ") + number_text(pose(r, c));
  }
  return text;
}

void write_scan(const SimulatedSequence& sequence, std::size_t index,
                simulated::SceneFolder& folder) {
  const Scan scan = sequence.load(index);
  const std::vector<std::uint32_t> labels = sequence.labels(scan);
  std::vector<float> values(4 * scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    std::memcpy(values.data() + 4 * i, scan.points[i].data(), 3 * sizeof(float));
    values[4 * i + 3] = scan.reflectance[i];
  }
  folder.write("velodyne/" + scan.name + ".bin", values.data(), values.size() * sizeof(float));
  folder.write("labels/" + scan.name + ".label", labels.data(),
               labels.size() * sizeof(std::uint32_t));
}

void write_tables(const SimulatedSequence& sequence, simulated::SceneFolder& folder) {
  const Pose Tr = camera_from_lidar();
  std::string poses;
  std::string times;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    poses += row_text(Tr * sequence.pose(i) * Tr.inverse()) + "\n";
    times += number_text(static_cast<double>(i) * sequence.scan_period_s()) + "\n";
  }
  const std::string projection = "718.856 0 607.1928 0 0 718.856 185.2157 0 0 0 1 0";
  std::string calib;
  for (const char* camera : {"P0", "P1", "P2", "P3"}) {
    calib += std::string(camera) + ": " + projection + "\n";
  }
  folder.write("poses.txt", poses);
  folder.write("times.txt", times);
  folder.write("calib.txt", calib + "Tr: " + row_text(Tr) + "\n");
}

/// What is said of the world's axes; nothing of 0 degrees.
std::string angle_text(const std::string& what, double degrees) {
  return degrees == 0.0 ? "" : what + number_text(degrees) + " degrees";
}

void write_description(const SimulationOptions& options, const SimulatedSequence& sequence,
                       simulated::SceneFolder& folder) {
  const auto known = sensor_model_names();
  const bool named = std::find(known.begin(), known.end(), sequence.sensor_name()) != known.end();
  nlohmann::ordered_json record;
  record["name"] = sequence.name();
  record["source"] =
      "simulated by raymoval: scene " + sequence.name() + ", sensor " + sequence.sensor_name() +
      ", seed " + std::to_string(options.seed) + ", pose noise " + number_text(options.pose_noise) +
      ", rolling " + kRollingNames[static_cast<int>(options.rolling)] +
      (options.noise_free ? ", noise-free" : "") + angle_text(", turned by ", options.turned_deg) +
      angle_text(", tilted by ", options.tilted_deg);
  record["sensor"] = named ? sequence.sensor_name() : "estimated";
  record["scan_period_s"] = sequence.scan_period_s();
  record["poses"] = "poses.txt";
  record["range_m"] = {{"min", sequence.range_m().min}, {"max", sequence.range_m().max}};
  record["labels"] = {{"ignored", {0, 1}}, {"moving", {252, 253, 254, 255, 256, 257, 258, 259}}};
  folder.write("sequence.json", record.dump(2) + "\n");
}

/// Times (seconds) from which a mover moves or stands, for the whole sequence.
nlohmann::ordered_json moves_of(const SimulatedSequence& sequence, std::size_t mover,
                                const std::vector<std::vector<MoverTruth>>& states) {
  nlohmann::ordered_json changes = nlohmann::ordered_json::array();
  std::string last;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const MoverTruth& truth = states[i][mover];
    const std::string state =
        !truth.present ? "away" : (std::abs(truth.speed_mps) > 0.01 ? "moves" : "stands");
    if (state == last) continue;
    last = state;
    const Eigen::Vector3d at = truth.T_world_mover.translation();
    changes.push_back({{"scan", i},
                       {"time_s", static_cast<double>(i) * sequence.scan_period_s()},
                       {"state", state},
                       {"at", {at.x(), at.y(), at.z()}}});
  }
  return changes;
}

void write_movers(const SimulatedSequence& sequence, simulated::SceneFolder& folder) {
  std::vector<std::vector<MoverTruth>> states;
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    states.push_back(sequence.movers(static_cast<double>(i) * sequence.scan_period_s()));
  }
  nlohmann::ordered_json movers = nlohmann::ordered_json::array();
  for (std::size_t m = 0; m < states.front().size(); ++m) {
    const MoverTruth& truth = states.front()[m];
    movers.push_back({{"instance", truth.instance},
                      {"label", truth.semantic},
                      {"kind", truth.kind},
                      {"moves", truth.moves},
                      {"when", moves_of(sequence, m, states)}});
  }
  folder.write("movers.json", movers.dump(1) + "\n");
}

}  // namespace

namespace simulated {

void write_scene(const SceneWriting& writing, const fs::path& folder) {
  const auto sequence = make_simulated(writing.options, writing.threads);
  SceneFolder files(folder);
  Progress* progress = writing.progress;
  if (progress != nullptr) progress->begin("simulating " + sequence->name(), sequence->size());
  parallel_for(writing.threads, sequence->size(), 1, [&](std::size_t i) {
    if (writing.cancel != nullptr && writing.cancel->load()) throw Cancelled();
    write_scan(*sequence, i, files);
    if (progress != nullptr) progress->advance();
  });
  if (progress != nullptr) progress->end();
  write_tables(*sequence, files);
  write_description(writing.options, *sequence, files);
  write_movers(*sequence, files);
  files.finish(writing.identity);
}

}  // namespace simulated

void write_simulated(const SimulationOptions& options, const fs::path& folder, int threads,
                     Progress* progress, const std::atomic<bool>* cancel) {
  if (is_there(folder) && (!is_folder(folder) || !entries_of(folder).empty())) {
    throw DataError(
        folder.string() +
        ": exists already and is not an empty folder; remove it or choose another one.");
  }
  (void)make_folders(folder_of(folder));  // An error shows when the place is made.
  simulated::MakingPlace place(folder);
  simulated::write_scene({options, "", threads, progress, cancel}, place.folder());
  if (!place.take_place()) {
    throw DataError(folder.string() + ": something else took this name meanwhile.");
  }
}

}  // namespace raymoval
