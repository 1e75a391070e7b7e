// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "datasets/sequence.h"

namespace raymoval {

/// Hash of everything a method or protocol reads: points, reflectance, times, poses and labels of
/// the chosen frames, sensor model, label rule, range limits, and up if it is not the world's z.
/// File and sequence names are left out: a copy of the data elsewhere has the same fingerprint.
/// @param threads used for reading; the result does not depend on it
std::string fingerprint(const Sequence& sequence, int threads);

}  // namespace raymoval
