// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "benchmark/cli/description.h"
#include "eval/protocol_registry.h"
#include "python/module/bindings.h"

namespace raymoval::python {
namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    for (const MethodVariant& variant : entry->variants) {
      names.push_back(entry->name + ":" + variant.name);
    }
  }
  return names;
}

std::vector<std::string> protocol_names() {
  std::vector<std::string> names;
  for (const ProtocolEntry& entry : protocol_entries()) names.push_back(entry.name);
  return names;
}

}  // namespace

void bind_descriptions(py::module_& module) {
  module.def("method_names", &method_names);
  module.def("protocol_names", &protocol_names);
  module.def(
      "describe",
      [](const std::string& name) { return described(MethodRegistry::built_in(), name); },
      py::arg("name"));
}

}  // namespace raymoval::python
