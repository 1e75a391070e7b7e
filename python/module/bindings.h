// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

namespace raymoval::python {

namespace py = pybind11;

// Each function adds a part of the module `_raymoval`, from the source file of its name. The public
// API is in the Python package `raymoval`, which calls these.

void bind_errors(py::module_& module);
void bind_sensors(py::module_& module);
void bind_scans(py::module_& module);
void bind_sequences(py::module_& module);
void bind_masks(py::module_& module);
void bind_remover(py::module_& module);
void bind_descriptions(py::module_& module);
void bind_poses(py::module_& module);
void bind_clean(py::module_& module);
void bind_scores(py::module_& module);
void bind_runs(py::module_& module);

}  // namespace raymoval::python
