// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/raymoval/parameters.h"
#include "methods/registry.h"

namespace raymoval {

/// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping".
std::unique_ptr<Remover> make_raymoval(const RaymovalParameters& parameters);

MethodEntry raymoval_entry();

}  // namespace raymoval
