// SPDX-License-Identifier: MIT
#include "benchmark/process/machine.h"

#include <cmath>
#include <fstream>

#include "benchmark/process/build_commit.h"
#include "core/parallel.h"
#include "core/process/proc_files.h"

namespace raymoval {
BuildRecord build_record() {
  return {RAYMOVAL_VERSION, build_commit(), build_tree(), RAYMOVAL_COMPILER, RAYMOVAL_BUILD_TYPE};
}

MachineRecord machine_record(int threads) {
  MachineRecord machine{proc_field("/proc/cpuinfo", "model name"), hardware_threads()};
  const auto memory = proc_mib("/proc/meminfo", "MemTotal");
  if (memory) machine.memory_gib = std::llround(*memory / 1024.0);
  machine.threads = threads;
  return machine;
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
