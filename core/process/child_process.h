// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// What a child process may use; 0 = as much as it likes.
struct ChildLimits {
  double seconds = 0.0;     ///< Wall time from its start.
  double memory_mib = 0.0;  ///< Resident memory that is no file's, all its descendants included.
};

/// How a child process is started.
struct ChildSetup {
  std::vector<std::string> arguments;  ///< After the program's own name.
  /// {this process's, the child's}: 3 and above, or 1 and 2 for output that is not to be caught.
  std::vector<std::pair<int, int>> descriptors;
  ChildLimits limits;
  const std::atomic<bool>* cancel = nullptr;  ///< Set: the child is ended.
};

/// How a child process ended.
struct ChildEnd {
  enum class Kind { kExited, kSignalled, kTimeout, kOutOfMemory, kCancelled };
  Kind kind = Kind::kExited;
  int code = 0;              ///< Exit code, or number of the signal.
  std::string output_tail;   ///< End of what it printed on standard output and error.
  double largest_mib = 0.0;  ///< Largest memory that was seen.
};

/// Runs this very program (/proc/self/exe) with other arguments and waits for its end.
///
/// The child is a new program and not a mere fork, since threads of this process (TBB's) would be
/// missing in a fork, and its memory would count as the child's. It gets a session of its own, so
/// that it can be ended with all that it started, no standard input, and no core file; it dies with
/// the thread that called this. Memory is watched from here every 20 ms and not limited by
/// RLIMIT_AS or RLIMIT_DATA, which count what is mapped and never touched (thread stacks, arenas,
/// a sanitizer's shadow).
/// @throws DataError if no process can be started
ChildEnd run_child(const ChildSetup& setup);

/// Memory of the machine in MiB, or of the control group if that is less; 0 if it is not told.
double machine_memory_mib();

/// The memory limit where a user says none: nine tenths of `machine_memory_mib`.
double usual_memory_limit_mib();

/// "signal 11 (Segmentation fault)".
std::string signal_text(int signal);

}  // namespace raymoval
