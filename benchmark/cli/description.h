// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "methods/registry.h"

namespace raymoval {

/// What `raymoval describe NAME --all` prints of one of `methods` or of a protocol.
/// @throws UsageError, ConfigurationError that suggest the nearest name
std::string described(const MethodRegistry& methods, const std::string& name);

}  // namespace raymoval
