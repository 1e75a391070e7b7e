// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <utility>

#include "benchmark/process/checked_sink.h"
#include "benchmark/process/method_run.h"
#include "benchmark/process/timed_source.h"
#include "core/parallel.h"
#include "core/scan/local_frame.h"
#include "python/module/bindings.h"
#include "python/module/descriptions.h"
#include "python/module/interruptible.h"
#include "python/module/masks.h"
#include "python/module/remover.h"

namespace raymoval::python {
namespace {

/// Runs `remover` as `raymoval clean` does, and keeps its masks.
MaskStore find_removals(const Sequence& sequence, const std::string& name, Remover& remover,
                        int threads, const WorkContext& work) {
  const LocalFrameSource local(*sequence.scans, sequence.method_frame());
  const TimedSource scans(local);
  CheckedSink sink(name, scans);
  RunContext context;
  context.threads = threads > 0 ? threads : hardware_threads();
  context.progress = work.progress;
  context.cancel = work.cancel;
  remover.run(scans, sink, context);
  work.progress->end();
  return sink.finish();
}

HeldMasks answer(const HeldSequence& held, const std::string& name, Remover& remover, int threads,
                 const py::object& on_progress) {
  HeldMasks masks;
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    masks.masks = find_removals(*held.sequence, name, remover, threads, work);
  });
  if (held.arrays) masks.left_out = held.arrays->left_out();
  return masks;
}

/// @param settings values of parameters by name, as texts
HeldMasks clean(const HeldSequence& held, const std::string& method,
                const std::vector<std::pair<std::string, std::string>>& settings, int threads,
                const py::object& on_progress) {
  const ConfiguredMethod configured = configured_method(method, settings);
  const auto remover = make_remover(configured, *held.sequence);
  return answer(held, configured.full_name(), *remover, threads, on_progress);
}

HeldMasks clean_with(const HeldSequence& held, const std::string& name, const py::object& method,
                     int threads, const py::object& on_progress) {
  const auto remover = python_remover(method);
  return answer(held, name, *remover, threads, on_progress);
}

}  // namespace

void bind_clean(py::module_& module) {
  module.def("clean", &clean, py::arg("sequence"), py::arg("method"), py::arg("settings"),
             py::arg("threads"), py::arg("on_progress"));
  module.def("clean_with", &clean_with, py::arg("sequence"), py::arg("name"), py::arg("method"),
             py::arg("threads"), py::arg("on_progress"));
}

}  // namespace raymoval::python
