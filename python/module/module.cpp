// SPDX-License-Identifier: MIT
#include "python/module/bindings.h"

PYBIND11_MODULE(_raymoval, module) {
  using namespace raymoval::python;
  module.doc() = "The compiled part of raymoval. Use the package `raymoval`, which calls it.";
  module.attr("__version__") = RAYMOVAL_VERSION;
  bind_errors(module);
  bind_sensors(module);
  bind_scans(module);
  bind_sequences(module);
  bind_masks(module);
  bind_remover(module);
  bind_descriptions(module);
  bind_poses(module);
  bind_clean(module);
  bind_scores(module);
  bind_runs(module);
}
