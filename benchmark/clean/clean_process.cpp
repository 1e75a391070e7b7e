// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_process.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <exception>
#include <set>
#include <system_error>
#include <vector>

#include "core/files/file_kind.h"
#include "core/files/part_name.h"
#include "core/files/scratch_folder.h"
#include "core/process/child_process.h"
#include "core/progress.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// Unfinished files and folders beside the outputs.
std::set<fs::path> unfinished(const CleanPaths& paths) {
  std::set<fs::path> found;
  for (const OutputPath& output : paths.all()) {
    const std::vector<fs::path> parts = parts_of(fs::absolute(output.path).lexically_normal());
    found.insert(parts.begin(), parts.end());
  }
  return found;
}

/// Removes what a child leaves behind that is ended.
class LeftOvers {
 public:
  explicit LeftOvers(const CleanPaths& paths)
      : paths_(paths), before_(unfinished(paths)), had_(present()) {}
  ~LeftOvers() {
    try {
      remove();
    } catch (const std::exception&) {
      // What cannot be found now stays under a name that tells what it is.
    }
  }
  LeftOvers(const LeftOvers&) = delete;
  LeftOvers& operator=(const LeftOvers&) = delete;

 private:
  void remove() const {
    remove_abandoned_scratch_folders();
    // The child was ended between two renames: what was there has another name and is the user's.
    if (present() != had_) return;
    std::error_code ignored;
    for (const fs::path& path : unfinished(paths_)) {
      if (before_.count(path) == 0) fs::remove_all(path, ignored);
    }
  }
  /// The outputs that are there, for a folder may be away under another name.
  [[nodiscard]] std::vector<fs::path> present() const {
    std::vector<fs::path> there;
    for (const OutputPath& output : paths_.all()) {
      if (is_folder_output(output.kind) && is_there(output.path)) there.push_back(output.path);
    }
    return there;
  }
  const CleanPaths& paths_;
  std::set<fs::path> before_;
  std::vector<fs::path> had_;
};

ExitCode answer_of(const ChildEnd& end, double limit_mib) {
  if (asking_signal(end) != 0) {
    throw DataError(fmt::format("cleaning was ended from outside by {}. Nothing was written.",
                                signal_text(asking_signal(end))));
  }
  switch (end.kind) {
    case ChildEnd::Kind::kNotStarted:
      throw DataError(not_started_text(end.code));
    case ChildEnd::Kind::kCancelled:
    case ChildEnd::Kind::kTimeout:    // There is no limit on time,
    case ChildEnd::Kind::kOutOfDisk:  // and none on its folder.
      throw Cancelled();
    case ChildEnd::Kind::kOutOfMemory:
      throw DataError(fmt::format(
          "cleaning took more than {:.0f} MiB of memory (see --memory-limit) and was ended. "
          "Nothing "
          "was written. Choose fewer --frames, a larger --voxel, or a method that needs less.{}",
          limit_mib, end.memory_note));
    case ChildEnd::Kind::kSignalled:
      if (end.code == SIGKILL) {
        throw DataError(fmt::format(
            "cleaning was killed from outside when it had {:.0f} MiB of memory: by the system if "
            "memory ran out, or by somebody. Nothing was written.",
            end.largest_mib));
      }
      throw MethodError(
          fmt::format("cleaning crashed: {}. Nothing was written. Try another --method.",
                      signal_text(end.code)));
    case ChildEnd::Kind::kExited:
      break;
  }
  if (end.code >= 0 && end.code <= static_cast<int>(ExitCode::kInternal)) {
    return static_cast<ExitCode>(end.code);
  }
  throw MethodError(
      fmt::format("cleaning ended with exit code {}. Nothing was written.", end.code));
}

}  // namespace

ExitCode clean_apart(const std::vector<std::string>& arguments, const CleanPaths& paths,
                     double memory_limit_mib, const std::atomic<bool>& cancel) {
  const fs::path first = paths.all().front().path;
  const auto before = identity_of(first);
  ChildSetup setup;
  setup.arguments = {"raymoval"};
  setup.arguments.insert(setup.arguments.end(), arguments.begin(), arguments.end());
  setup.descriptors = {{STDOUT_FILENO, STDOUT_FILENO}, {STDERR_FILENO, STDERR_FILENO}};
  setup.limits.memory_mib = memory_limit_mib;
  setup.cancel = &cancel;
  ChildEnd end;
  {
    const LeftOvers left_overs(paths);
    end = run_child(setup);
  }
  // The line with its progress may still be on the terminal.
  if (end.kind != ChildEnd::Kind::kExited) Progress(progress_style_of_stderr()).end();
  const ExitCode answer = answer_of(end, memory_limit_mib);
  const auto after = identity_of(first);
  if (answer == ExitCode::kDone && (!after || after == before)) {
    throw MethodError("cleaning ended without a map and without an error. Try another --method.");
  }
  return answer;
}

}  // namespace raymoval
