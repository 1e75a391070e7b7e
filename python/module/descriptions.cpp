// SPDX-License-Identifier: MIT
#include "python/module/descriptions.h"

#include <pybind11/stl.h>

#include "core/parameter_condition.h"
#include "eval/protocol_registry.h"
#include "python/module/bindings.h"

namespace raymoval::python {
namespace {

py::object object_of(const ParameterValue& value) {
  return std::visit([](const auto& one) -> py::object { return py::cast(one); }, value);
}

py::object limit(double value) {
  return std::isfinite(value) ? py::object(py::float_(value)) : py::object(py::none());
}

py::dict parameter(const ParameterSpec& spec, const ParameterValue& value, bool acts) {
  py::dict described;
  described["name"] = spec.name;
  described["default"] = object_of(value);
  described["unit"] = spec.notes.unit;
  described["minimum"] = limit(spec.notes.minimum);
  described["maximum"] = limit(spec.notes.maximum);
  described["choices"] = py::cast(spec.choices);
  described["source"] = spec.notes.source;
  described["sentence"] = spec.notes.sentence;
  described["acts_when"] = spec.notes.acts_when;
  described["acts"] = acts;
  return described;
}

py::list variants_of(const MethodEntry& entry) {
  py::list variants;
  for (const MethodVariant& variant : entry.variants) {
    py::dict values, described;
    for (const auto& [name, value] : variant.overrides) values[py::str(name)] = object_of(value);
    described["name"] = variant.name;
    described["sentence"] = variant.sentence;
    described["online"] = variant.online;
    described["values"] = values;
    variants.append(described);
  }
  return variants;
}

/// A method with the values of its variant as defaults.
py::dict describe_method(const std::string& name) {
  const ConfiguredMethod method = MethodRegistry::built_in().configure(name);
  const MethodEntry& entry = *method.entry;
  py::dict described;
  described["name"] = method.full_name();
  described["sentence"] = entry.sentence;
  described["source"] = entry.source;
  described["version"] = entry.version;
  described["online"] = method.variant.online;
  described["notes"] = py::cast(entry.notes);
  described["variants"] = variants_of(entry);
  py::list parameters;
  for (std::size_t i = 0; i < entry.parameters.size(); ++i) {
    parameters.append(parameter(entry.parameters[i], method.configuration[i].second,
                                has_effect(entry.parameters[i], method.configuration)));
  }
  described["parameters"] = parameters;
  return described;
}

const char* role_name(RateRole role) {
  switch (role) {
    case RateRole::kKept:
      return "kept";
    case RateRole::kRemoved:
      return "removed";
    case RateRole::kHeadline:
      return "headline";
    case RateRole::kMean:
      return "mean";
    case RateRole::kSecondary:
      break;
  }
  return "secondary";
}

py::dict describe_protocol(const std::string& name) {
  const ProtocolEntry& entry = protocol_entry(name);
  py::dict described;
  described["name"] = entry.name;
  described["sentence"] = entry.sentence;
  described["version"] = entry.version;
  py::list options, rates;
  for (const ParameterSpec& spec : entry.parameters) {
    options.append(parameter(spec, spec.default_value, true));
  }
  for (const RateSpec& spec : entry.rates) {
    py::dict rate;
    rate["name"] = spec.name;
    rate["unit"] = spec.unit == RateUnit::kPercent ? "percent" : "fraction";
    rate["decimals"] = spec.decimals;
    rate["higher_is_better"] = spec.higher_is_better;
    rate["role"] = role_name(spec.role);
    rates.append(rate);
  }
  described["options"] = options;
  described["rates"] = rates;
  return described;
}

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

void bind_descriptions(py::module_& module) {
  module.def("method_names", &method_names);
  module.def("protocol_names", &protocol_names);
  module.def("describe_method", &describe_method, py::arg("name"));
  module.def("describe_protocol", &describe_protocol, py::arg("name"));
}

}  // namespace raymoval::python
