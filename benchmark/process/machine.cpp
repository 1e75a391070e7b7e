// SPDX-License-Identifier: MIT
#include "benchmark/process/machine.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "benchmark/process/build_commit.h"
#include "core/parallel.h"
#include "core/process/proc_files.h"

namespace raymoval {
nlohmann::ordered_json build_record() {
  return {{"version", RAYMOVAL_VERSION},
          {"commit", build_commit()},
          {"source_tree", build_tree()},
          {"compiler", RAYMOVAL_COMPILER},
          {"build_type", RAYMOVAL_BUILD_TYPE}};
}

nlohmann::ordered_json machine_record() {
  const auto memory = proc_mib("/proc/meminfo", "MemTotal");
  return {{"processor", proc_field("/proc/cpuinfo", "model name")},
          {"cores", hardware_threads()},
          {"memory_gib",
           memory ? nlohmann::ordered_json(static_cast<long>(*memory / 1024.0 + 0.5)) : nullptr}};
}

bool reset_peak_memory() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

std::optional<double> peak_memory_mib() {
  return proc_mib("/proc/self/status", "VmHWM");
}

}  // namespace raymoval
