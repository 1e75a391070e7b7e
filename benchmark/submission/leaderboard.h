// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "benchmark/submission/verification.h"
#include "benchmark/tables/text/text_table.h"

namespace raymoval {

/// A table for each sequence and protocol with the methods whose submissions hold, the best first;
/// controls are left out. What else a submission was scored by, and in which order, does not
/// matter. Ranks come from pairs: a method's rank is one more than the number of methods whose
/// headline rate is better by an interval (`paired_difference`) that does not reach 0. Methods that
/// the data does not tell apart may share a rank, and none is called better.
/// @param verified each of the data and protocols that its cell says
std::vector<TextTable> leaderboard(const std::vector<Verification>& verified);

}  // namespace raymoval
