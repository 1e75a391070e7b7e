// SPDX-License-Identifier: MIT
#include "benchmark/process/command_process.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>

#include "core/files/scratch_folder.h"
#include "core/process/child_process.h"
#include "core/progress.h"

namespace raymoval {
namespace {

ExitCode answer_of(const ChildEnd& end, const CommandWords& words, double limit_mib) {
  if (asking_signal(end) != 0) {
    throw DataError(fmt::format("{} was ended from outside by {}.{}", words.doing,
                                signal_text(asking_signal(end)), words.outcome));
  }
  switch (end.kind) {
    case ChildEnd::Kind::kNotStarted:
      throw DataError(not_started_text(end.code));
    case ChildEnd::Kind::kCancelled:
    case ChildEnd::Kind::kTimeout:    // The command has no limit on time,
    case ChildEnd::Kind::kOutOfDisk:  // and none on disk space.
      throw Cancelled();
    case ChildEnd::Kind::kOutOfMemory:
      throw DataError(fmt::format(
          "{} took more than {:.0f} MiB of memory (see --memory-limit) and was ended.{}{}{}",
          words.doing, limit_mib, words.outcome, words.less_memory, end.memory_note));
    case ChildEnd::Kind::kSignalled:
      if (end.code == SIGKILL) {
        throw DataError(
            fmt::format("{} was killed from outside when it had {:.0f} MiB of memory: by the "
                        "system if memory ran out, or by a user.{}",
                        words.doing, end.largest_mib, words.outcome));
      }
      throw MethodError(fmt::format("{} crashed: {}.{}{}", words.doing, signal_text(end.code),
                                    words.outcome, words.after_crash));
    case ChildEnd::Kind::kExited:
      break;
  }
  if (end.code >= 0 && end.code <= static_cast<int>(ExitCode::kInternal)) {
    return static_cast<ExitCode>(end.code);
  }
  throw MethodError(
      fmt::format("{} ended with exit code {}.{}", words.doing, end.code, words.outcome));
}

}  // namespace

ExitCode run_command_in_child(const std::vector<std::string>& arguments, const CommandWords& words,
                              double memory_limit_mib, const std::atomic<bool>& cancel) {
  ChildSetup setup;
  setup.arguments = {"raymoval"};
  setup.arguments.insert(setup.arguments.end(), arguments.begin(), arguments.end());
  setup.descriptors = {{STDOUT_FILENO, STDOUT_FILENO}, {STDERR_FILENO, STDERR_FILENO}};
  setup.limits.memory_mib = memory_limit_mib;
  setup.cancel = &cancel;
  const ChildEnd end = run_child(setup);
  remove_abandoned_scratch_folders();
  // The line with its progress may still be on the terminal.
  if (end.kind != ChildEnd::Kind::kExited) Progress(progress_style_of_stderr()).end();
  return answer_of(end, words, memory_limit_mib);
}

}  // namespace raymoval
