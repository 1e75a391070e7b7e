// SPDX-License-Identifier: MIT
#include "benchmark/process/machine.h"

#include <fstream>
#include <nlohmann/json.hpp>
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

nlohmann::ordered_json build_record() {
  nlohmann::ordered_json record;
  record["version"] = RAYMOVAL_VERSION;
  record["commit"] = build_commit();
  record["source_tree"] = build_tree();
  record["compiler"] = RAYMOVAL_COMPILER;
  record["build_type"] = RAYMOVAL_BUILD_TYPE;
  return record;
}

nlohmann::ordered_json machine_record() {
  nlohmann::ordered_json record;
  record["processor"] = proc_field("/proc/cpuinfo", "model name");
  record["cores"] = hardware_threads();
  const auto memory = kibibytes(proc_field("/proc/meminfo", "MemTotal"));
  record["memory_gib"] =
      memory ? nlohmann::ordered_json(static_cast<long>(*memory / 1048576.0 + 0.5)) : nullptr;
  return record;
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
