// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

namespace raymoval::python {

namespace py = pybind11;

/// A reference to a Python object that threads may copy and let go with or without the GIL.
class SharedObject {
 public:
  SharedObject() = default;
  /// To be called with the GIL.
  explicit SharedObject(py::object object)
      : held_(new py::object(std::move(object)), [](py::object* held) {
          if (Py_IsInitialized() == 0) return;  // The interpreter is gone, and all objects with it.
          const py::gil_scoped_acquire gil;
          delete held;
        }) {}
  /// To be used with the GIL.
  [[nodiscard]] const py::object& get() const { return *held_; }
  [[nodiscard]] explicit operator bool() const { return held_ != nullptr; }

 private:
  std::shared_ptr<py::object> held_;
};

}  // namespace raymoval::python
