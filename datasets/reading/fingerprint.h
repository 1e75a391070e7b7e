// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/files/files.h"
#include "datasets/sequence.h"

namespace raymoval {

// What counts of a sequence for its `fingerprint` (datasets/sequence.h), part by part.

/// Time, pose, points and reflectance; not the name.
void add_scan(ContentHasher& hasher, const Scan& scan);
void add_labels(ContentHasher& hasher, const std::vector<std::uint32_t>& labels);
/// Sensor model, range limits, label rule. @throws DataError if the sensor is estimated and a scan
/// cannot be read
void add_settings(ContentHasher& hasher, const Sequence& sequence);

}  // namespace raymoval
