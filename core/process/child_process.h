// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// What a child process may use. 0 means that there is no limit.
struct ChildLimits {
  double seconds = 0.0;     ///< Wall time from its start.
  double memory_mib = 0.0;  ///< Of the child and its descendants, see `FamilyMemory`.
  /// Of the files below its working folder on the disk, roughly.
  double folder_mib = 0.0;
};

/// The program that calls this.
inline constexpr const char* kThisProgram = "/proc/self/exe";

/// How a child process is started.
struct ChildSetup {
  std::string program = kThisProgram;  ///< The path of its file.
  std::vector<std::string> arguments;  ///< The first one is the program's own name.
  std::filesystem::path folder = {};   ///< Its working folder; empty: that of this process.
  /// Variables in addition to the variables of this process; they replace variables of the same
  /// name.
  std::vector<std::pair<std::string, std::string>> environment = {};
  /// {this process's, the child's}: 3 and above, or 1 and 2 for output that is not to be caught.
  std::vector<std::pair<int, int>> descriptors = {};
  ChildLimits limits = {};
  /// The child is ended when this becomes true. If another process ended the child, the call waits
  /// a fifth of a second for it: a system that shuts down may signal the child before this process.
  const std::atomic<bool>* cancel = nullptr;
};

/// How a child process ended.
struct ChildEnd {
  enum class Kind {
    kNotStarted,
    kExited,
    kSignalled,
    kTimeout,
    kOutOfMemory,
    kOutOfDisk,
    kCancelled
  };
  Kind kind = Kind::kExited;
  int code = 0;              ///< Exit code, number of the signal, or system's error number.
  std::string output_tail;   ///< The end of its standard output and error.
  double largest_mib = 0.0;  ///< The largest memory that was seen.
  /// What a message about memory has to add; empty, or a sentence that begins with a blank.
  std::string memory_note;
};

/// Runs a program as a child process, waits for its end, and ends all processes that it started and
/// left behind, as it does when a limit is exceeded or the child is cancelled.
///
/// The child is a new program and not a mere fork, since threads of this process (TBB's) would be
/// missing in a fork, and its memory would count as the child's. It gets a session of its own, no
/// standard input, no descriptor that `setup` does not name, the default for each signal, and no
/// core file; it dies with the thread that called this. Memory is watched from here every 20 ms and
/// not limited by RLIMIT_AS or RLIMIT_DATA, which count what is mapped and never touched (thread
/// stacks, arenas, a sanitizer's shadow). The working folder is measured about once a second.
///
/// Until this returns, this process is the foster parent of its descendants (see `SubreaperScope`).
/// It waits for its child and that child's descendants only, so that this may be called beside
/// other children and in several threads.
ChildEnd run_child(const ChildSetup& setup);

/// Why a child could not be started, and what to do about it: "no process can be started (Resource
/// temporarily unavailable). End other programs, or raise the limit of processes (ulimit -u)."
std::string not_started_text(int reason);

/// "signal 11 (Segmentation fault)".
std::string signal_text(int signal);

/// The signal (SIGINT, SIGTERM or SIGHUP) that ended a child, directly or by the exit code that
/// shells derive from it; else 0.
int asking_signal(const ChildEnd& end);

}  // namespace raymoval
