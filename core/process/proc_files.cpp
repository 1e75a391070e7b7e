// SPDX-License-Identifier: MIT
#include "core/process/proc_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/text.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// The names of a folder's entries, as far as they can be read: processes end while they are looked
/// at.
std::vector<std::string> names_now(const fs::path& folder) {
  std::vector<std::string> names;
  // The forms that take an error_code end the program if they have no memory.
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      names.push_back(entry.path().filename().string());
    }
  } catch (const fs::filesystem_error&) {
    // The process ended; the names found up to now are returned.
  }
  return names;
}

/// Amount in MiB of a line such as "RssAnon:     1234 kB".
std::optional<double> mib_of_line(std::string_view line) {
  const auto words = split_blanks(line.substr(line.find(':') + 1));
  const auto kibibytes = words.empty() ? std::nullopt : parse_number<double>(words.front());
  return kibibytes ? std::optional(*kibibytes / 1024.0) : std::nullopt;
}

}  // namespace

std::string proc_field(const fs::path& file, std::string_view key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t colon = line.find(':');
    if (!line.starts_with(key) || colon == std::string::npos) continue;
    const std::size_t start = line.find_first_not_of(" \t", colon + 1);
    return start == std::string::npos ? "" : line.substr(start);
  }
  return "";
}

std::optional<double> proc_mib(const fs::path& file, std::string_view key) {
  return proc_mib_sum(file, {key});
}

std::optional<double> proc_mib_sum(const fs::path& file,
                                   std::initializer_list<std::string_view> keys) {
  std::ifstream lines(file);
  std::size_t found = 0;
  double sum = 0.0;
  for (std::string line; found < keys.size() && std::getline(lines, line);) {
    const std::string_view key = std::string_view(line).substr(0, line.find(':'));
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) continue;
    const auto mib = mib_of_line(line);
    if (!mib) return std::nullopt;
    sum += *mib;
    ++found;
  }
  return found == keys.size() ? std::optional(sum) : std::nullopt;
}

fs::path proc_folder(pid_t process) {
  return fmt::format("/proc/{}", process);
}

ProcessState process_state(pid_t process) {
  std::ifstream file(proc_folder(process) / "stat");
  std::string text;
  std::getline(file, text, '\0');
  ProcessState state;
  // The name of the program is in parentheses and may contain blanks and parentheses.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return state;
  std::istringstream fields(text.substr(name_end + 1));
  pid_t group = 0;
  fields >> state.letter >> state.parent >> group >> state.session;
  return state;
}

std::vector<pid_t> all_processes() {
  std::vector<pid_t> processes;
  for (const std::string& name : names_now("/proc")) {
    if (const auto process = parse_number<pid_t>(name)) processes.push_back(*process);
  }
  return processes;
}

std::vector<pid_t> children_by_parent(pid_t process) {
  std::vector<pid_t> children = all_processes();
  std::erase_if(children, [&](pid_t child) { return process_state(child).parent != process; });
  return children;
}

std::vector<pid_t> children_of(pid_t process) {
  static const bool are_listed = std::ifstream("/proc/thread-self/children").is_open();
  if (!are_listed) return children_by_parent(process);
  std::vector<pid_t> children;
  const fs::path threads = proc_folder(process) / "task";
  for (const std::string& thread : names_now(threads)) {
    std::ifstream file(threads / thread / "children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
  }
  return children;
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
