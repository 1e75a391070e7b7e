// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "datasets/sequence.h"
#include "methods/remover.h"

namespace raymoval {

/// Whether the clouds of `sequence` are merged from several sensors, so that each cloud has to be
/// split.
bool is_merged(const Sequence& sequence);

/// `method` for merged clouds of several sensors: it gets each cloud as one scan for each sensor,
/// in the order of the sensors' numbers, whose points and pose have their origin where the beams
/// of that sensor start. Its answers are put together again, so that masks have the indices of the
/// merged clouds. Points within 5 cm of their sensor are missing returns and are kept.
/// @param sequence with `sensor_origin`; must outlive the result
/// @return `method` itself if the sequence is not of merged clouds
std::unique_ptr<Remover> with_split_sensors(std::unique_ptr<Remover> method,
                                            const Sequence& sequence);

}  // namespace raymoval
