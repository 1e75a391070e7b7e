// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "python/module/shared_object.h"

namespace raymoval::python {

/// A method that is an object in Python with run(scans, sink).
/// @param object with the GIL
std::unique_ptr<Remover> python_remover(const py::object& object);

/// The entry of a method in Python. Its exceptions become a MethodError with the message and place
/// of the exception.
/// @param described a dict with name, sentence, version, online, parameters (a dict of values), and
///   make: called with the values of the parameters, it gives the object
/// @throws UsageError for a parameter that is no bool, number or text
MethodEntry python_entry(const py::dict& described);

}  // namespace raymoval::python
