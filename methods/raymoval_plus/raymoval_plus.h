// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/raymoval_plus/common/parameters.h"

namespace raymoval {
namespace raymoval_plus_method {

/// Removes what the rays of all scans contradict, in the eight steps of README.md beside this file.
std::unique_ptr<Remover> make_raymoval_plus(const Parameters& parameters);

}  // namespace raymoval_plus_method

MethodEntry raymoval_plus_entry();

}  // namespace raymoval
