// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <utility>

#include "benchmark/process/method_run.h"
#include "core/parallel.h"
#include "python/module/bindings.h"
#include "python/module/interruptible.h"
#include "python/module/masks.h"
#include "python/module/remover.h"

namespace raymoval::python {
namespace {

HeldMasks answer(const HeldSequence& held, const std::string& name, Remover& remover, int threads,
                 const py::object& on_progress) {
  HeldMasks masks;
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    MethodRequest request;
    request.name = name;
    MethodTask task{held.sequence.get(), &request};
    task.options.threads = threads > 0 ? threads : hardware_threads();
    task.progress = work.progress;
    task.cancel = work.cancel;
    masks.masks = run_remover(remover, task).masks;
    work.progress->end();
  });
  if (held.arrays) masks.left_out = held.arrays->left_out();
  return masks;
}

/// A method of raymoval with values of its parameters.
/// @param settings names and texts
/// @throws UsageError, ConfigurationError that suggest the nearest name
ConfiguredMethod configured_method(
    const std::string& name, const std::vector<std::pair<std::string, std::string>>& settings) {
  ConfiguredMethod method = MethodRegistry::built_in().configure(name);
  const std::string& owner = method.entry->name;
  for (const auto& [key, text] : settings) {
    const ParameterSpec& spec = find_parameter(owner, method.entry->parameters, key);
    set_parameter(method.configuration, key, checked_value_from_text(owner, spec, text));
  }
  return method;
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
