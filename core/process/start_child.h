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
  Descriptor output;   ///< What it prints on standard output and error comes out here.
  std::string mark;    ///< Of its family, see `ProcessFamily`.
};

/// Starts a child process as `run_child` says. If memory runs out, the system ends the child or
/// what it has started before this process.
StartedChild start_child(const ChildSetup& setup);

}  // namespace raymoval
