// SPDX-License-Identifier: MIT
#include "benchmark/process/machine.h"

#include <fstream>
#include <string>

#include "benchmark/process/build_commit.h"
#include "core/parallel.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// What stands after "key" and its colon in a file of /proc; empty if it is not there.
std::string proc_field(const char* path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (!line.starts_with(key) || colon == std::string::npos) continue;
    const std::size_t start = line.find_first_not_of(" \t", colon + 1);
    return start == std::string::npos ? "" : line.substr(start);
  }
  return "";
}

std::optional<double> kibibytes(const std::string& field) {
  const auto pieces = split_blanks(field);
  return pieces.empty() ? std::nullopt : parse_number<double>(pieces.front());
}

}  // namespace

BuildRecord build_record() {
  return {RAYMOVAL_VERSION, build_commit(), build_tree(), RAYMOVAL_COMPILER, RAYMOVAL_BUILD_TYPE};
}

MachineRecord machine_record(int threads) {
  MachineRecord machine{proc_field("/proc/cpuinfo", "model name"), hardware_threads()};
  const auto memory = kibibytes(proc_field("/proc/meminfo", "MemTotal"));
  if (memory) machine.memory_gib = static_cast<std::int64_t>(*memory / 1048576.0 + 0.5);
  machine.threads = threads;
  return machine;
}

bool reset_peak_memory() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

std::optional<double> peak_memory_mib() {
  const auto peak = kibibytes(proc_field("/proc/self/status", "VmHWM"));
  if (!peak) return std::nullopt;
  return *peak / 1024.0;
}

}  // namespace raymoval
