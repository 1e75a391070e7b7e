// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "methods/registry.h"

namespace raymoval::python {

/// A method of raymoval with values of its parameters.
/// @param settings names and texts
/// @throws UsageError, ConfigurationError that suggest the nearest name
ConfiguredMethod configured_method(
    const std::string& name, const std::vector<std::pair<std::string, std::string>>& settings);

}  // namespace raymoval::python
