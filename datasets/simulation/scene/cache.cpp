// SPDX-License-Identifier: MIT
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_lock.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/text.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/scene_writer.h"
#include "datasets/simulation/scene/simulated.h"

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
    if (scene.writing.cancel != nullptr && scene.writing.cancel->load()) throw Cancelled();
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

}  // namespace raymoval
