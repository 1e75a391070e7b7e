// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/peopleremover/parameters.h"

namespace raymoval {
namespace peopleremover_method {

/// The Peopleremover: change detection by traversing a voxel occupancy grid (Schauer and Nuechter,
/// RA-L 3(3), 2018, and ISPRS J. 2018), written from a description of the public program (3DTK).
///
/// A voxel is freed if a beam of some scan passes through it, it holds points, and none of them is
/// of that scan (or of one within `diff` scans). Points in freed voxels are dynamic, and so are
/// points of a scan that has others in a freed voxel nearby.
///
/// Decisions, and what differs from the public program, are the `notes` of the entry.
std::unique_ptr<Remover> make_peopleremover(const Parameters& parameters);

}  // namespace peopleremover_method

MethodEntry peopleremover_entry();

}  // namespace raymoval
