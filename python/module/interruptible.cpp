// SPDX-License-Identifier: MIT
#include "python/module/interruptible.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "core/error.h"

namespace raymoval::python {

/// A running task, and the state of the thread that waits for it.
struct Call {
  std::atomic<bool> cancel = false;
  Progress progress;
  /// The thread that is in Python code, as Python numbers threads; 0: none. It is read and written
  /// with the GIL.
  unsigned long python_thread = 0;

  std::mutex mutex;  ///< Of the members below.
  std::condition_variable changed;
  bool is_done = false;
  std::exception_ptr error = nullptr;
};

namespace {

constexpr std::chrono::milliseconds kBetweenLooks{50};

/// The work that this thread does; null if it does none.
thread_local Call* own_call = nullptr;

void do_work(Call& call, const std::function<void(const WorkContext&)>& work) {
  own_call = &call;
  std::exception_ptr error;
  try {
    work({&call.progress, &call.cancel});
  } catch (...) {
    error = std::current_exception();
  }
  const std::lock_guard lock(call.mutex);
  call.error = error;
  call.is_done = true;
  call.changed.notify_all();
}

/// The thread of a work, which is waited for.
class WorkThread {
 public:
  WorkThread(Call& call, const std::function<void(const WorkContext&)>& work)
      : thread_([&call, &work] { do_work(call, work); }) {}
  ~WorkThread() { join(); }
  WorkThread(const WorkThread&) = delete;
  WorkThread& operator=(const WorkThread&) = delete;
  /// Without the GIL, which the work may wait for.
  void join() {
    if (!thread_.joinable()) return;
    const py::gil_scoped_release without_gil;
    thread_.join();
  }

 private:
  std::thread thread_;
};

/// Lets the work go on until it is done or the next look is due. @return whether it is done
bool wait_for(Call& call) {
  const py::gil_scoped_release without_gil;
  std::unique_lock lock(call.mutex);
  return call.changed.wait_for(lock, kBetweenLooks, [&] { return call.is_done; });
}

/// Requests the work to stop, also if it is in Python code.
void stop(Call& call) {
  call.cancel = true;
  if (call.python_thread != 0) {
    PyThreadState_SetAsyncExc(call.python_thread, PyExc_KeyboardInterrupt);
  }
}

/// Handles signals and progress while a thread waits for the work.
class Watch {
 public:
  Watch(Call& call, const py::object& on_progress)
      : call_(call), on_progress_(on_progress), outer_(own_call) {}

  void look() {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      // A work within a work, which is not the main thread's, is stopped with that one.
      if (outer_ != nullptr && outer_->cancel) throw Cancelled();
      tell_progress();
    } catch (...) {
      if (!raised_) raised_ = std::current_exception();
      stop(call_);
    }
  }
  /// What was raised while it was waited for comes before what the work threw because of that.
  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
    if (call_.error) std::rethrow_exception(call_.error);
  }
  /// The last state, which may have come between two looks.
  void tell_progress() {
    if (raised_ || on_progress_.is_none()) return;
    const ProgressState state = call_.progress.state();
    if (state == told_) return;
    told_ = state;
    on_progress_(state.context, state.task, state.tasks, state.done, state.total);
  }

 private:
  Call& call_;
  const py::object& on_progress_;
  Call* outer_;
  ProgressState told_;
  std::exception_ptr raised_;
};

}  // namespace

PythonScope::PythonScope() : call_(own_call) {
  if (call_ == nullptr) return;
  outer_ = call_->python_thread;
  call_->python_thread = PyThread_get_thread_ident();
}

PythonScope::~PythonScope() {
  if (call_ != nullptr) call_->python_thread = outer_;
}

void run_interruptibly(const py::object& on_progress,
                       const std::function<void(const WorkContext&)>& work) {
  Call call;
  Watch watch(call, on_progress);
  {
    WorkThread thread(call, work);
    while (!wait_for(call)) watch.look();
    thread.join();
  }
  // A Ctrl-C just before the end belongs to this call.
  if (call.error) watch.look();
  watch.rethrow();
  watch.tell_progress();
}

}  // namespace raymoval::python
