// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_process.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <optional>
#include <set>
#include <system_error>

#include "benchmark/cli/commands.h"
#include "core/process/child_process.h"
#include "core/text.h"
#include "methods/external/working_folder.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// Unfinished files and folders beside the outputs.
std::set<fs::path> unfinished(const CleanPaths& paths) {
  std::set<fs::path> found;
  for (const fs::path& output : {paths.map, paths.removed, paths.labels}) {
    if (output.empty()) continue;
    const fs::path whole = fs::absolute(output).lexically_normal();
    const fs::path named = whole.has_filename() ? whole : whole.parent_path();
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(named.parent_path(), error)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(named.filename().string() + ".") && name.ends_with(".part")) {
        found.insert(entry.path());
      }
    }
  }
  return found;
}

/// Removes what a child that was ended could not.
class LeftOvers {
 public:
  explicit LeftOvers(const CleanPaths& paths)
      : paths_(paths), before_(unfinished(paths)), had_labels_(has_labels()) {}
  ~LeftOvers() {
    // Ended between two renames: what was there stands under another name and is the user's.
    if (has_labels() != had_labels_) return;
    std::error_code ignored;
    for (const fs::path& path : unfinished(paths_)) {
      if (before_.count(path) == 0) fs::remove_all(path, ignored);
    }
    remove_abandoned_working_folders();
  }
  LeftOvers(const LeftOvers&) = delete;
  LeftOvers& operator=(const LeftOvers&) = delete;

 private:
  [[nodiscard]] bool has_labels() const {
    std::error_code ignored;
    return !paths_.labels.empty() && fs::exists(paths_.labels, ignored);
  }
  const CleanPaths& paths_;
  std::set<fs::path> before_;
  bool had_labels_;
};

/// The words of this command, told to stay in its process.
std::vector<std::string> arguments_of_child() {
  std::vector<std::string> arguments = program_arguments();
  const auto command = std::find(arguments.begin(), arguments.end(), "clean");
  arguments.insert(command == arguments.end() ? command : command + 1, "--in-process");
  return arguments;
}

/// Which file `path` is; one that takes its place is another. Nothing: there is none.
std::optional<std::pair<dev_t, ino_t>> identity_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return std::pair{status.st_dev, status.st_ino};
}

ExitCode answer_of(const ChildEnd& end, double limit_mib) {
  const std::string nothing = " Nothing was written.";
  switch (end.kind) {
    case ChildEnd::Kind::kCancelled:
    case ChildEnd::Kind::kTimeout:  // There is no limit on time.
      throw Cancelled();
    case ChildEnd::Kind::kOutOfMemory:
      throw DataError("cleaning took more than " + fixed_text(limit_mib, 0) +
                      " MiB of memory (see --memory-limit) and was ended." + nothing +
                      " Choose fewer --frames, a larger --voxel, or a method that needs less.");
    case ChildEnd::Kind::kSignalled:
      if (end.code == SIGKILL) {
        throw DataError(
            "cleaning was killed from outside when it had " + fixed_text(end.largest_mib, 0) +
            " MiB of memory: by the system if memory ran out, or by somebody." + nothing);
      }
      throw MethodError("cleaning crashed: " + signal_text(end.code) + "." + nothing +
                        " Try another --method.");
    case ChildEnd::Kind::kExited:
      break;
  }
  if (end.code >= 0 && end.code <= static_cast<int>(ExitCode::kInternal)) {
    return static_cast<ExitCode>(end.code);
  }
  throw MethodError("cleaning ended with exit code " + std::to_string(end.code) + "." + nothing);
}

}  // namespace

ExitCode clean_apart(const CleanPaths& paths, double memory_limit_mib) {
  const auto map_before = identity_of(paths.map);
  ChildEnd end;
  {
    const LeftOvers left_overs(paths);
    end = run_child({arguments_of_child(),
                     {{STDOUT_FILENO, STDOUT_FILENO}, {STDERR_FILENO, STDERR_FILENO}},
                     {0.0, memory_limit_mib},
                     &interrupt_flag()});
  }
  // Its live line may stand there still.
  if (end.kind != ChildEnd::Kind::kExited) Progress(progress_style_of_stderr()).end();
  const ExitCode answer = answer_of(end, memory_limit_mib);
  const auto map = identity_of(paths.map);
  if (answer == ExitCode::kDone && (!map || map == map_before)) {
    throw MethodError(
        "cleaning ended without a map, though it told no fault. Try another --method.");
  }
  return answer;
}

}  // namespace raymoval
