// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "core/scan/range_limits.h"
#include "core/scan/scan_source.h"
#include "datasets/simulation/sensor/rolling.h"

namespace raymoval {

namespace simulated {
class World;
}  // namespace simulated

/// Options of a simulation. The same options give the same bytes, on any number of threads.
struct SimulationOptions {
  std::string scene = "town";  ///< Name of a scene, or path of a scene file (ends in .json).
  std::string sensor = "";     ///< Name or path; empty = the scene's sensor.
  std::uint64_t seed = 1;      ///< Of movers, noise and poses.
  std::size_t scans = 0;       ///< 0 = the scene's number.
  double pose_noise = 1.0;     ///< Severity; 0 = perfect poses, 1 = a good LiDAR odometry.
  Rolling rolling = Rolling::kNone;
  bool noise_free = false;  ///< Perfect ranges without loss, for tests.
  /// The axes of the sequence's world, in degrees: turned about z, which is up, and then tilted
  /// about the new x, so that z is not up. The scans do not change by a bit.
  double turned_deg = 0.0, tilted_deg = 0.0;
  /// Turns of the sensor in the vehicle's frame (x forward, y left, z up), in degrees: first about
  /// x, then about y, then about z. The vehicle, its path and the sequence's world stay.
  double roll_deg = 0.0, pitch_deg = 0.0, yaw_deg = 0.0;

  /// The angles that are 0 by default, with the names that `parse_scene` gives them.
  [[nodiscard]] std::vector<std::pair<std::string, double>> angles() const {
    return {{"turned", turned_deg},
            {"tilted", tilted_deg},
            {"roll", roll_deg},
            {"pitch", pitch_deg},
            {"yaw", yaw_deg}};
  }
};

/// The true motion of one mover, for records and tests.
struct MoverTruth {
  std::uint16_t instance = 0;  ///< Upper half of its label words.
  std::uint16_t semantic = 0;  ///< Lower half.
  std::string kind;
  bool moves = false;  ///< At any time of the sequence.
  bool present = false;
  Pose T_world_mover = Pose::Identity();
  double speed_mps = 0.0;
};

/// A simulated sequence; a scan is traced when it is requested. Its world frame is at the sensor of
/// scan 0 (x forward, y left), as in SemanticKITTI, but levelled: z is up, unless the options turn
/// or tilt it. Thread-safe.
class SimulatedSequence : public ScanSource, public LabelSource {
 public:
  ~SimulatedSequence() override = default;
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The sensor's true pose, without the error that `pose` has.
  [[nodiscard]] virtual Pose true_pose(std::size_t scan) const = 0;
  /// All movers at `time_s`.
  [[nodiscard]] virtual std::vector<MoverTruth> movers(double time_s) const = 0;
  [[nodiscard]] virtual double scan_period_s() const = 0;
  [[nodiscard]] virtual RangeLimits range_m() const = 0;
  [[nodiscard]] virtual const std::string& sensor_name() const = 0;
  /// The world in its own frame, and the pose of this frame in the frame of the sequence.
  [[nodiscard]] virtual const simulated::World& world() const = 0;
  [[nodiscard]] virtual Pose T_sequence_world() const = 0;
};

/// @param threads used to prepare the scene
/// @throws UsageError for an unknown scene or sensor or more scans than its route has room for;
/// ConfigurationError for a damaged file of one; DataError for a file that cannot be read.
std::shared_ptr<const SimulatedSequence> make_simulated(const SimulationOptions& options,
                                                        int threads = 1);

/// Names of the built-in scenes and sensors, sorted.
std::vector<std::string> simulated_scene_names();
std::vector<std::string> simulated_sensor_names();

/// Text of a built-in scene or sensor file: a start for one's own. @throws UsageError
std::string simulated_scene_text(const std::string& name);
std::string simulated_sensor_text(const std::string& name);

/// Writes the SemanticKITTI layout: velodyne/, labels/, poses.txt (camera convention), calib.txt,
/// times.txt, sequence.json, movers.json (when each mover moves), and manifest.json (the identity
/// of the scene). `folder` appears whole or not at all, also after a power failure.
/// @param cancel checked before each scan
/// @throws DataError if `folder` exists and is not an empty folder, or cannot be written; Cancelled
void write_simulated(const SimulationOptions& options, const std::filesystem::path& folder,
                     int threads, Progress* progress, const std::atomic<bool>* cancel = nullptr);

/// $RAYMOVAL_CACHE, else $XDG_CACHE_HOME/raymoval, else ~/.cache/raymoval.
/// @throws ConfigurationError if none of the variables nor HOME is set.
std::filesystem::path default_cache_root();

/// Folder of the sequence below `cache_root`; generates it if it is missing. Its name has a hash of
/// scene file, sensor file, options and simulator version.
///
/// Machines and containers may share the cache. If another process generates the scene, the call
/// waits for it (a lock in the cache; on a file system without locks, both generate it and one
/// result is kept). A folder of the cache is valid if it has its manifest.json, all tables and the
/// scene's number of scans and labels. Otherwise it is generated again, with a message.
/// @throws as write_simulated; DataError if the cache cannot be written; UnreadableError if it
///   cannot be read, because the folder may be valid then
std::filesystem::path cached_simulation(const SimulationOptions& options,
                                        const std::filesystem::path& cache_root, int threads,
                                        Progress* progress,
                                        const std::atomic<bool>* cancel = nullptr);

/// Whether `cached_simulation` would not generate the sequence. @throws as `cached_simulation`
bool is_cached(const SimulationOptions& options, const std::filesystem::path& cache_root);

}  // namespace raymoval
