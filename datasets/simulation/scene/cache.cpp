// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/file_kind.h"
#include "core/files/file_lock.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/files/replacements.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/scan/sensor_model.h"
#include "core/text.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/simulated.h"

static_assert(std::endian::native == std::endian::little, "files hold little-endian numbers");

namespace raymoval::simulated {
namespace {

/// Name of the file that marks a whole folder of a scene.
constexpr const char* kManifestName = "manifest.json";

/// A scene to write, and the options.
struct SceneWriting {
  const SimulationOptions& options;
  std::string identity;  ///< Written into the mark; see `scene_folder_problem`.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;  ///< Checked before each scan.
};

namespace fs = std::filesystem;

constexpr int kManifestVersion = 1;

[[noreturn]] void throw_unwritable(const fs::path& path) {
  throw DataError(path.string() + ": cannot be written (" + std::generic_category().message(errno) +
                  "); the disk may be full or the folder read-only.");
}

/// Writes and syncs a new file. It needs no temporary name, because the whole folder appears
/// atomically.
void write_synced(const fs::path& path, const void* data, std::size_t size) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.valid()) throw_unwritable(path);
  const bool written = write_at(file.get(), {static_cast<const char*>(data), size}, 0);
  if (!written || ::fsync(file.get()) != 0) throw_unwritable(path);
}

/// Writes the files of a new folder and, last, its mark. Members throw DataError naming the
/// path and the system's reason.
class SceneFolder {
 public:
  /// @param folder exists and is empty
  explicit SceneFolder(fs::path folder) : folder_(std::move(folder)) {
    for (const char* name : {"velodyne", "labels"}) {
      std::error_code error;
      fs::create_directory(folder_ / name, error);
      if (!error) continue;
      throw DataError((folder_ / name).string() + ": cannot be made (" + error.message() +
                      "). Choose a folder you may write to.");
    }
  }

  /// Writes and syncs a file. Thread-safe.
  /// @param name relative to the folder, below velodyne/ or labels/ or in the folder itself
  void write(const std::string& name, const void* data, std::size_t size) const {
    write_synced(folder_ / name, data, size);
  }
  void write(const std::string& name, const std::string& text) const {
    write(name, text.data(), text.size());
  }

  /// Writes the mark and syncs the names of all files.
  void finish(const std::string& identity) const {
    nlohmann::ordered_json json;
    json["schema_version"] = kManifestVersion;
    json["identity"] = identity;
    for (const char* below : {"velodyne", "labels"}) sync_folder(folder_ / below);
    const std::string text = json.dump(1) + "\n";
    write_synced(folder_ / kManifestName, text.data(), text.size());
    sync_folder(folder_);
  }

 private:
  fs::path folder_;
};

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

void write_scan(const SimulatedSequence& sequence, std::size_t index, const SceneFolder& folder) {
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

void write_tables(const SimulatedSequence& sequence, const SceneFolder& folder) {
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

/// The angles other than 0: ", turned by 30 degrees".
std::string angles_text(const SimulationOptions& options) {
  std::string text;
  for (const auto& [name, degrees] : options.angles()) {
    if (degrees != 0.0) text += ", " + name + " by " + number_text(degrees) + " degrees";
  }
  return text;
}

void write_description(const SimulationOptions& options, const SimulatedSequence& sequence,
                       const SceneFolder& folder) {
  const auto known = sensor_model_names();
  const bool named = std::find(known.begin(), known.end(), sequence.sensor_name()) != known.end();
  nlohmann::ordered_json record;
  record["name"] = sequence.name();
  record["source"] = "simulated by raymoval: scene " + sequence.name() + ", sensor " +
                     sequence.sensor_name() + ", seed " + std::to_string(options.seed) +
                     ", pose noise " + number_text(options.pose_noise) + ", rolling " +
                     kRollingNames[static_cast<int>(options.rolling)] +
                     (options.noise_free ? ", noise-free" : "") + angles_text(options);
  record["sensor"] = named ? sequence.sensor_name() : "estimated";
  record["scan_period_s"] = sequence.scan_period_s();
  record["poses"] = "poses.txt";
  record["range_m"] = {{"min", sequence.range_m().min}, {"max", sequence.range_m().max}};
  record["labels"] = {{"ignored", {0, 1}}, {"moving", {252, 253, 254, 255, 256, 257, 258, 259}}};
  folder.write("sequence.json", record.dump(2) + "\n");
}

/// Times (seconds) from which a mover moves or is stationary, for the whole sequence.
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

void write_movers(const SimulatedSequence& sequence, const SceneFolder& folder) {
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

void write_files(const SceneWriting& writing, const fs::path& folder) {
  const auto sequence = make_simulated(writing.options, writing.threads);
  const SceneFolder files(folder);
  Progress* progress = writing.progress;
  if (progress != nullptr) progress->begin("simulating " + sequence->name(), sequence->size());
  parallel_for(writing.threads, sequence->size(), 1, [&](std::size_t i) {
    throw_if_cancelled(writing.cancel);
    write_scan(*sequence, i, files);
    if (progress != nullptr) progress->advance();
  });
  if (progress != nullptr) progress->end();
  write_tables(*sequence, files);
  write_description(writing.options, *sequence, files);
  write_movers(*sequence, files);
  files.finish(writing.identity);
}

/// "velodyne/ has 4 scans, written were 3"; empty if the folder has as many.
std::string count_problem(const fs::path& folder, const char* below, const char* extension,
                          std::size_t scans) {
  if (!has_folder(folder / below)) return std::string(below) + "/ is missing";
  const std::vector<fs::path> there = entries_of(folder / below);
  const auto found =
      static_cast<std::size_t>(std::count_if(there.begin(), there.end(), [&](const fs::path& path) {
        return path.extension() == extension;
      }));
  if (found == scans) return "";
  return std::string(below) + "/ has " + counted_text(found, "scan") + ", written were " +
         std::to_string(scans);
}

/// Writes the files of a scene into a new folder beside `target`, its mark last, and
/// renames it to `target`, which it replaces. A folder with the mark is whole, also after a power
/// failure.
/// @param is_made called when all is written: whether `target` is the scene by now, and is kept
/// @throws as `make_simulated`; DataError if a file cannot be written; Cancelled
void write_scene(const SceneWriting& writing, const fs::path& target,
                 const std::function<bool()>& is_made) {
  Part part = new_part_folder(target);
  if (!part.held.valid()) {
    throw DataError(part.place.string() + ": cannot be made (" +
                    std::generic_category().message(errno) +
                    "). Choose a folder you may write to.");
  }
  const fs::path place = part.place;
  try {
    write_files(writing, place);
    if (is_made()) {
      fs::remove_all(place);
      return;
    }
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(place, ignored);
    throw;
  }
  Replacements all;
  all.add(std::move(part), target);
  all.commit();
}

/// Why `folder` is not the scene that was written as `identity`: no mark, a missing file, or
/// another number of scans. Empty if it is. Contents are not compared.
/// @throws UnreadableError (see core/files/file_kind.h)
std::string scene_folder_problem(const fs::path& folder, const std::string& identity,
                                 std::size_t scans) {
  try {
    for (const char* name :
         {kManifestName, "poses.txt", "times.txt", "calib.txt", "sequence.json"}) {
      if (!has_file(folder / name)) return std::string(name) + " is missing";
    }
    if (read_json(folder / kManifestName).at("identity") != identity)
      return "it is of another scene";
    const std::string problem = count_problem(folder, "velodyne", ".bin", scans);
    return problem.empty() ? count_problem(folder, "labels", ".label", scans) : problem;
  } catch (const nlohmann::json::exception&) {
    return std::string(kManifestName) + " is damaged";
  } catch (const UnreadableError&) {
    throw;  // The folder may be right.
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace
}  // namespace raymoval::simulated

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// Increased whenever the same files would give other bytes.
constexpr const char* kSimulatorVersion = "2";

std::string identity(const SimulationOptions& options, const simulated::NamedText& world,
                     const simulated::NamedText& sensor, std::size_t scans) {
  ContentHasher hasher;
  const auto add = [&](const std::string& text) {
    hasher.add(std::to_string(text.size()) + ":");  // so that different lists differ in the hash
    hasher.add(text);
  };
  add(kSimulatorVersion);
  add(world.name);
  add(world.text);
  add(sensor.name);
  add(sensor.text);
  add(std::to_string(options.seed));
  add(std::to_string(scans));
  add(number_text(options.pose_noise));
  add(std::to_string(static_cast<int>(options.rolling)));
  add(options.noise_free ? "noise-free" : "noisy");
  for (const auto& [name, angle] : options.angles()) {
    if (angle != 0.0) add(name + " " + number_text(angle));
  }
  return hasher.digest();
}

const char* set_variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : nullptr;
}

/// A scene with its place in the cache.
struct CachedScene {
  simulated::SceneWriting writing;
  fs::path folder;
  std::size_t scans = 0;

  /// Why it must be generated again; only for an existing folder.
  [[nodiscard]] std::string problem() const {
    return simulated::scene_folder_problem(folder, writing.identity, scans);
  }
  [[nodiscard]] bool is_whole() const { return has_folder(folder) && problem().empty(); }
  void say(const std::string& line) const {
    if (writing.progress != nullptr) writing.progress->say(line);
  }
};

/// @param writing its identity is computed here
CachedScene scene_in(const fs::path& cache_root, simulated::SceneWriting writing) {
  const SimulationOptions& options = writing.options;
  const simulated::NamedText world = simulated::find_world(options.scene);
  const simulated::WorldFile file = simulated::parse_world(world);
  const simulated::NamedText sensor =
      simulated::find_sensor(options.sensor.empty() ? file.sensor : options.sensor);
  const std::size_t scans =
      options.scans > 0 ? options.scans : static_cast<std::size_t>(file.scans);
  writing.identity = identity(options, world, sensor, scans);
  const std::string name = world.name + "-" + writing.identity.substr(0, 16);
  return {std::move(writing), cache_root / "simulated" / name, scans};
}

/// Waits until the lock is held. On a file system without locks it does not wait: two processes may
/// generate the scene, and one result is kept.
void wait_for_turn(const CachedScene& scene, FileLock& lock) {
  bool told = false;
  while (lock.take(FileLock::Mode::kExclusive) == FileLock::State::kBusy) {
    throw_if_cancelled(scene.writing.cancel);
    if (!told) {
      scene.say("waiting for " + lock.holder() + ", which makes " + scene.folder.string());
    }
    told = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

/// Removes remains of killed processes from the cache. A lock that can be acquired is unused; its
/// object removes it.
void sweep_cache(const fs::path& folder) {
  for (const fs::path& entry : entries_of(folder)) {
    remove_abandoned_part(entry);
    if (entry.extension() != ".lock" || !is_file(entry)) continue;
    try {
      FileLock(entry).take(FileLock::Mode::kExclusive);
    } catch (const DataError&) {
      // A file of another user, in a cache that is shared for reading.
    }
  }
}

void make_scene(const CachedScene& scene) {
  const fs::path parent = scene.folder.parent_path();
  std::error_code error;
  fs::create_directories(parent, error);
  if (error) {
    throw DataError(parent.string() + ": cannot be made (" + error.message() +
                    "). Set RAYMOVAL_CACHE to a folder you may write to.");
  }
  FileLock lock(scene.folder.string() + ".lock");
  try {
    wait_for_turn(scene, lock);
  } catch (const DataError& unwritable) {
    throw DataError(std::string(unwritable.what()) +
                    " Set RAYMOVAL_CACHE to a folder you may write to.");
  }
  if (scene.is_whole()) return;
  sweep_cache(parent);
  // Without locks, another process may have been faster, with the same bytes.
  simulated::write_scene(scene.writing, scene.folder, [&] { return scene.is_whole(); });
  const std::string problem = scene.problem();
  if (problem.empty()) return;
  throw DataError(scene.folder.string() + ": was just made, and " + problem +
                  ". Something else changes the cache; set RAYMOVAL_CACHE to another folder.");
}

}  // namespace

fs::path default_cache_root() {
  if (const char* own = set_variable("RAYMOVAL_CACHE")) return own;
  if (const char* cache = set_variable("XDG_CACHE_HOME")) return fs::path(cache) / "raymoval";
  if (const char* home = set_variable("HOME")) return fs::path(home) / ".cache" / "raymoval";
  throw ConfigurationError(
      "there is no place for the cache: set RAYMOVAL_CACHE to a folder (HOME is not set).");
}

fs::path cached_simulation(const SimulationOptions& options, const fs::path& cache_root,
                           int threads, Progress* progress, const std::atomic<bool>* cancel) {
  const CachedScene scene = scene_in(cache_root, {options, "", threads, progress, cancel});
  if (has_folder(scene.folder)) {
    const std::string problem = scene.problem();
    if (problem.empty()) {
      sweep_cache(scene.folder.parent_path());
      return scene.folder;
    }
    scene.say(scene.folder.string() + ": differs from what was written there (" + problem +
              "); it is simulated again.");
  }
  make_scene(scene);
  return scene.folder;
}

bool is_cached(const SimulationOptions& options, const fs::path& cache_root) {
  return scene_in(cache_root, {options, ""}).is_whole();
}

void write_simulated(const SimulationOptions& options, const std::filesystem::path& folder,
                     int threads, Progress* progress, const std::atomic<bool>* cancel) {
  const auto check_free = [&] {
    if (!is_there(folder) || (is_folder(folder) && entries_of(folder).empty())) return false;
    throw DataError(
        folder.string() +
        ": exists already and is not an empty folder; remove it or choose another one.");
  };
  check_free();
  (void)make_folders(folder_of(folder));  // An error shows when the files are written.
  simulated::write_scene({options, "", threads, progress, cancel}, without_slash(folder),
                         check_free);
}

}  // namespace raymoval
