// SPDX-License-Identifier: MIT
#include "benchmark/clean/clean_process.h"

#include <exception>
#include <set>
#include <system_error>
#include <vector>

#include "benchmark/process/command_process.h"
#include "core/files/file_kind.h"
#include "core/files/part_name.h"

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

/// Removes the unfinished files of a child process that was ended.
class UnfinishedOutputs {
 public:
  explicit UnfinishedOutputs(const CleanPaths& paths)
      : paths_(paths), before_(unfinished(paths)), had_(present()) {}
  ~UnfinishedOutputs() {
    try {
      remove();
    } catch (const std::exception&) {
      // An unfinished file that cannot be found now remains; its name marks it as unfinished.
    }
  }
  UnfinishedOutputs(const UnfinishedOutputs&) = delete;
  UnfinishedOutputs& operator=(const UnfinishedOutputs&) = delete;

 private:
  void remove() const {
    // The child was ended between two renames: the user's earlier output has another name now.
    if (present() != had_) return;
    std::error_code ignored;
    for (const fs::path& path : unfinished(paths_)) {
      if (before_.count(path) == 0) fs::remove_all(path, ignored);
    }
  }
  /// The outputs that exist: during a replacement a folder has another name.
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

}  // namespace

ExitCode clean_in_child(const std::vector<std::string>& arguments, const CleanPaths& paths,
                        double memory_limit_mib, const std::atomic<bool>& cancel) {
  const fs::path first = paths.all().front().path;
  const auto before = identity_of(first);
  const UnfinishedOutputs left_overs(paths);
  const ExitCode answer = run_command_in_child(
      arguments,
      {.doing = "cleaning",
       .outcome = " Nothing was written.",
       .less_memory = " Choose fewer --frames, a larger --voxel, or a method that needs less.",
       .after_crash = " Try another --method."},
      memory_limit_mib, cancel);
  const auto after = identity_of(first);
  if (answer == ExitCode::kDone && (!after || after == before)) {
    throw MethodError("cleaning ended without a map and without an error. Try another --method.");
  }
  return answer;
}

}  // namespace raymoval
