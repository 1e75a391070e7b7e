// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "methods/raymoval/kernels/first_hit.h"
#include "methods/raymoval/parameters.h"
#include "methods/registry.h"

namespace raymoval {

/// Casts an image of first hits from a pose: all members of `image` are set.
using CastImage = std::function<void(OccupancyMap& map, const Pose& T_world_sensor, int threads,
                                     FirstHitImage& image)>;
/// Another way to cast images than `FirstHitCaster`, to compare it with; empty for that one.
using MakeCaster = std::function<CastImage(const AngularGrid& grid, const RayLimits& limits)>;

/// "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping".
std::unique_ptr<Remover> make_raymoval(const RaymovalParameters& parameters,
                                       const MakeCaster& make_caster = {});

MethodEntry raymoval_entry();

}  // namespace raymoval
