// SPDX-License-Identifier: MIT
#include "core/process/proc_files.h"

#include <algorithm>
#include <fstream>

#include "core/text.h"

namespace raymoval {

std::string proc_field(const std::filesystem::path& file, std::string_view key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    if (!line.starts_with(key) || colon == std::string::npos) continue;
    const std::size_t start = line.find_first_not_of(" \t", colon + 1);
    return start == std::string::npos ? "" : line.substr(start);
  }
  return "";
}

std::optional<double> proc_mib(const std::filesystem::path& file, std::string_view key) {
  const std::string field = proc_field(file, key);
  const auto kibibytes = parse_number<double>(field.substr(0, field.find(' ')));
  return kibibytes ? std::optional(*kibibytes / 1024.0) : std::nullopt;
}

double machine_memory_mib() {
  double mib = proc_mib("/proc/meminfo", "MemTotal").value_or(0.0);
  for (const char* path :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream file(path);
    std::string text;
    if (!(file >> text)) continue;
    const auto bytes = parse_number<double>(text);  // "max" is no number.
    if (bytes) mib = std::min(mib, *bytes / 1048576.0);
  }
  return mib;
}

double usual_memory_limit_mib() {
  return 0.9 * machine_memory_mib();
}

}  // namespace raymoval
