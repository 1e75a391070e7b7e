// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>

#include "benchmark/cli/command.h"
#include "core/text.h"
#include "datasets/semantickitti/semantickitti.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/scene_text.h"

namespace raymoval {
namespace {

struct SimulateFlags {
  std::string scene, output, seed, scans, sensor, pose_noise, rolling;
  bool perfect_poses = false;
  WorkFlags work;
};

SimulationOptions options_of(const SimulateFlags& flags) {
  SimulationOptions options = parse_scene(flags.scene);
  if (!flags.seed.empty()) options.seed = parse_seed("--seed", flags.seed);
  if (!flags.scans.empty()) options.scans = parse_scan_count("--scans", flags.scans);
  if (!flags.sensor.empty()) options.sensor = flags.sensor;
  if (!flags.rolling.empty()) options.rolling = parse_rolling("--rolling", flags.rolling);
  if (!flags.pose_noise.empty()) {
    options.pose_noise = parse_pose_noise("--pose-noise", flags.pose_noise);
  }
  if (flags.perfect_poses) {
    if (!flags.pose_noise.empty() && options.pose_noise > 0.0) {
      throw UsageError("--perfect-poses and --pose-noise contradict each other; leave one out.");
    }
    options.pose_noise = 0.0;
  }
  // Unknown names are reported before anything is made.
  (void)simulated::find_world(options.scene);
  if (!options.sensor.empty()) (void)simulated::find_sensor(options.sensor);
  return options;
}

/// The share of moving points, read from the written files.
std::string content_text(const std::string& folder) {
  const Sequence sequence = open_semantickitti(folder, {});
  std::uint64_t points = 0;
  std::uint64_t moving = 0;
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    const Scan scan = sequence.scans->load(i);
    points += scan.size();
    for (const std::uint32_t word : sequence.labels->labels(scan)) {
      moving += sequence.label_rule.classify(word) == LabelClass::kMoving ? 1 : 0;
    }
  }
  return counted_text(sequence.scans->size(), "scan") + ", " + counted_text(points, "point") +
         ", " + grouped_text(moving) + " of them on moving objects";
}

ExitCode simulate(const SimulateFlags& flags) {
  if (flags.scene.empty()) {
    throw UsageError("SCENE is missing: expected `raymoval simulate SCENE -o DIR`; scenes are " +
                     join(simulated_scene_names()) + ".");
  }
  if (flags.output.empty()) throw UsageError("-o DIR is missing: name the sequence's folder.");
  const SimulationOptions options = options_of(flags);
  Progress progress(flags.work.style());
  try {
    write_simulated(options, flags.output, flags.work.thread_count(), &progress, &interrupt_flag());
  } catch (...) {
    progress.end();
    throw;
  }
  print(flags.output + ": " + content_text(flags.output) + ".\n");
  return ExitCode::kDone;
}

}  // namespace

Command add_simulate_command(CommandParser& program) {
  auto flags = std::make_shared<SimulateFlags>();
  CommandOptions options =
      program.add_command("simulate", "Writes a simulated sequence with labels");
  options.add("scene", "SCENE", flags->scene,
              "A scene (see `raymoval list scenes`) or a scene file, *.json");
  options.add("-o,--output", "DIR", flags->output, "The new folder, in SemanticKITTI layout");
  options.add("--seed", "N", flags->seed, "The seed of movers, noise and poses (default: 1)");
  options.add("--scans", "N", flags->scans, "The number of scans (default: as in the scene)");
  options.add("--sensor", "NAME", flags->sensor,
              "A sensor (see `raymoval list simulated-sensors`) or a sensor file");
  options.add_flag("--perfect-poses", flags->perfect_poses,
                   "Write poses without error, as with --pose-noise 0");
  options.add("--pose-noise", "FACTOR", flags->pose_noise,
              "Scale of the error of the poses; 1 (default) is a good odometry");
  options.add("--rolling", "KIND", flags->rolling,
              "skewed or corrected: a scan is taken while the sensor moves (default: none)");
  flags->work.add_to(options);
  options.set_footer(
      "The same options give the same bytes. Commands that take a sequence also take a scene by\n"
      "name, such as town:scans=60,seed=3, and simulate it once into the cache folder\n"
      "($RAYMOVAL_CACHE, else ~/.cache/raymoval). Machines and containers may share the cache.\n"
      "A cached scene that is not whole is simulated again.\n"
      "roll, pitch and yaw turn the sensor in the vehicle's frame, in degrees: town:roll=90 has "
      "it\n"
      "on its side, roll=180 upside down, pitch=90 looking down. The vehicle's path stays.\n"
      "Examples:\n"
      "  raymoval simulate town -o data/town\n"
      "  raymoval simulate crossing -o data/crossing --scans 60 --sensor vlp16 --seed 3\n"
      "  raymoval simulate town:roll=90 -o data/side\n"
      "  raymoval simulate highway -o data/skewed --rolling skewed --perfect-poses");
  return {options.name(), [flags] { return simulate(*flags); }};
}

}  // namespace raymoval
