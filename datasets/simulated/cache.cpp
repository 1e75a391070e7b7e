// SPDX-License-Identifier: MIT
#include <chrono>
#include <cstdlib>
#include <system_error>

#include "core/error.h"
#include "core/files.h"
#include "core/text.h"
#include "datasets/simulated/library.h"
#include "datasets/simulated/simulated.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// Raised whenever the same files would give other bytes.
constexpr const char* kSimulatorVersion = "1";

std::string identity(const SimulationOptions& options, const simulated::NamedText& world,
                     const simulated::NamedText& sensor, std::size_t scans) {
  ContentHasher hasher;
  const auto add = [&](const std::string& text) {
    hasher.add(std::to_string(text.size()) + ":");  // so that no two lists read the same
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
  return hasher.digest();
}

/// Removes what killed runs left more than a day ago.
void sweep_leftovers(const fs::path& folder) {
  const auto yesterday = fs::file_time_type::clock::now() - std::chrono::hours(24);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".part") continue;
    if (entry.last_write_time(error) < yesterday && !error) fs::remove_all(entry.path(), error);
  }
}

const char* set_variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : nullptr;
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
  const simulated::NamedText world = simulated::find_world(options.scene);
  const simulated::WorldFile file = simulated::parse_world(world);
  const simulated::NamedText sensor =
      simulated::find_sensor(options.sensor.empty() ? file.sensor : options.sensor);
  const std::size_t scans =
      options.scans > 0 ? options.scans : static_cast<std::size_t>(file.scans);
  const fs::path folder =
      cache_root / "simulated" /
      (world.name + "-" + identity(options, world, sensor, scans).substr(0, 16));
  // A folder of this name is whole: it only ever gets its name by being renamed when finished.
  if (fs::is_directory(folder)) return folder;
  sweep_leftovers(folder.parent_path());
  try {
    write_simulated(options, folder, threads, progress, cancel);
  } catch (const DataError&) {
    if (!fs::is_directory(folder)) throw;  // else another run was faster with the same bytes
  }
  return folder;
}

}  // namespace raymoval
