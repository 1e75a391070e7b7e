// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <string>

#include "core/files/descriptor.h"
#include "core/process/child_process.h"

namespace raymoval {

/// A child process that was started, or the reason why it was not.
struct StartedChild {
  pid_t process = -1;  ///< -1 if it could not be started.
  int reason = 0;      ///< The system's error number if it could not be started.
  Descriptor output;   ///< Its standard output and error.
  std::string mark;    ///< Of its family, see `ProcessFamily`.
};

/// Starts a child process, see `run_child`.
/// @param oom_score_adj of the child and, since it is inherited, of all processes that it starts
StartedChild start_child(const ChildSetup& setup, int oom_score_adj);

}  // namespace raymoval
