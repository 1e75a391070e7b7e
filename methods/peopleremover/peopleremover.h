// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/method_entry.h"
#include "methods/peopleremover/parameters.h"

namespace raymoval {

/// The Peopleremover: change detection by traversing a voxel occupancy grid (Schauer and Nuechter,
/// RA-L 3(3), 2018, and ISPRS J. 2018), written from a description of the public program (3DTK).
///
/// A voxel is freed if a beam of some scan passes through it, it holds points, and none of them is
/// of that scan (or of one within `diff` scans). Points in freed voxels are dynamic, and so are
/// points of a scan that has others in a freed voxel nearby.
///
/// Decisions, and what differs from the public program:
/// - No set of scan numbers is kept per voxel. Whether a voxel holds a point of the beam's own
///   window is read off marks of that window's points; whether a point is in half(x), off its own
///   scan's points. Both are the same sets, and memory is bounded by the map.
/// - `maxrange_method = none` follows whole beams, as the program did before May 2020; its present
///   version follows none there and removes nothing.
/// - Points at or below `minimum_range`, which the program drops, are answered for: static.
/// - A point within two voxel diagonals of the sensor has no beam (the program takes the arc sine
///   of a value above 1).
/// - The normal is -u where the neighbourhood has fewer than three points or lies on a line, and no
///   beam passes its own point.
/// - Neighbours are found by chord (|u_j - u_k| < 2 sin(angle / 2)) in rows of equal height.
/// - Where a beam crosses two walls at once, it crosses them one by one, x before y before z.
/// - `reduce` draws from cells of a cap's solid angle, by a number that depends on seed, scan and
///   point; the program draws per cap from one generator that its threads share.
/// - `normal-method` has one value that works (angle) and `normal-knearest` no effect beside it:
///   neither is a parameter here. `1nearest` and the other methods of the program's help abort
///   there and are rejected here.
std::unique_ptr<Remover> make_peopleremover(const PeopleremoverParameters& parameters);

MethodEntry peopleremover_entry();

}  // namespace raymoval
