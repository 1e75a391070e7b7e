// SPDX-License-Identifier: MIT
#include "core/error.h"

#include "python/module/bindings.h"

namespace raymoval::python {
namespace {

/// The classes in Python, which live as long as the interpreter.
struct ErrorClasses {
  PyObject* error = nullptr;
  PyObject* usage = nullptr;
  PyObject* data = nullptr;
  PyObject* configuration = nullptr;
  PyObject* method = nullptr;
  PyObject* cancelled = nullptr;
  PyObject* internal = nullptr;
};
ErrorClasses& error_classes() {
  static ErrorClasses& classes = *new ErrorClasses;
  return classes;
}

PyObject* add_class(py::module_& module, const char* name, const py::object& bases,
                    const char* doc) {
  const std::string full_name = std::string("raymoval.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.add_object(name, made);
  return made;
}

/// The class that an error has in Python.
PyObject* class_of(const Error& error) {
  const ErrorClasses& classes = error_classes();
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return classes.usage;
  if (dynamic_cast<const DataError*>(&error) != nullptr) return classes.data;
  if (dynamic_cast<const ConfigurationError*>(&error) != nullptr) return classes.configuration;
  if (dynamic_cast<const MethodError*>(&error) != nullptr) return classes.method;
  if (dynamic_cast<const Cancelled*>(&error) != nullptr) return classes.cancelled;
  if (dynamic_cast<const InternalError*>(&error) != nullptr) return classes.internal;
  return classes.error;
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    PyErr_SetString(class_of(error), error.what());
  }
}

}  // namespace

void bind_errors(py::module_& module) {
  ErrorClasses& classes = error_classes();
  const auto borrowed = [](PyObject* object) { return py::reinterpret_borrow<py::object>(object); };
  const py::object value_error = borrowed(PyExc_ValueError);
  classes.error = add_class(module, "Error", borrowed(PyExc_Exception),
                            "Root of every error of raymoval. Its message says what is wrong, "
                            "where, what was expected, and what to do about it.");
  const py::object root = borrowed(classes.error);
  const py::object value = py::make_tuple(root, value_error);
  classes.usage = add_class(module, "UsageError", value,
                            "A call asks for something that does not exist or makes no sense.");
  classes.data =
      add_class(module, "DataError", value, "Data is missing, damaged, or contradicts itself.");
  classes.configuration =
      add_class(module, "ConfigurationError", value,
                "A parameter, suite or rule file has an unknown key or an illegal value.");
  classes.method = add_class(module, "MethodError", root,
                             "A method broke its contract (wrong mask size, missing scan) or could "
                             "not finish.");
  classes.cancelled = add_class(module, "Cancelled", root, "The run was asked to stop.");
  classes.internal =
      add_class(module, "InternalError", root, "A fault of raymoval and never of its user.");
  py::register_exception_translator(&translate);
}

}  // namespace raymoval::python
