// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>

#include "core/progress.h"

namespace raymoval::python {

namespace py = pybind11;

/// What work gets that may take long.
struct WorkContext {
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
};

/// Runs `work` without the GIL, on a separate thread, and waits for it. Meanwhile the calling
/// thread checks signals twenty times a second, so that Ctrl-C cancels the work (it throws
/// Cancelled at its next scan, and the call raises KeyboardInterrupt), and reports progress to
/// `on_progress`.
///
/// Python code that the work calls (a method, a sequence of scans) runs on the work's thread. If
/// that code is running at Ctrl-C, KeyboardInterrupt is raised there too.
/// @param on_progress called as on_progress(context, task, number of the task, done, total) when
///   the state has changed; None: no reports
/// @throws errors of `work`, of signal handlers and of `on_progress`
/// @note To be called with the GIL. Objects that `work` refers to outlive the call.
void run_interruptibly(const py::object& on_progress,
                       const std::function<void(const WorkContext&)>& work);

/// Marks that the calling thread, if it is that of a work, is in Python code, where Ctrl-C can
/// reach it. To be made and ended with the GIL.
class PythonScope {
 public:
  PythonScope();
  ~PythonScope();
  PythonScope(const PythonScope&) = delete;
  PythonScope& operator=(const PythonScope&) = delete;

 private:
  struct Call* call_;
  unsigned long outer_ = 0;
};

}  // namespace raymoval::python
