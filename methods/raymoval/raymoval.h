// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/raymoval/parameters.h"

namespace raymoval {
namespace raymoval_method {

/// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping".
std::unique_ptr<Remover> make_raymoval(const Parameters& parameters);

}  // namespace raymoval_method

MethodEntry raymoval_entry();

}  // namespace raymoval
