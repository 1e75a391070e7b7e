// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

namespace raymoval::python {

/// A float, or None where there is no number. To be called with the GIL.
inline pybind11::object optional_number(const std::optional<double>& value) {
  return value ? pybind11::object(pybind11::float_(*value)) : pybind11::object(pybind11::none());
}

}  // namespace raymoval::python
