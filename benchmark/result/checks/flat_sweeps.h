// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/results.h"

namespace raymoval {

/// A sentence for each parameter of a sweep without an effect: "tau0 made no difference: with each
/// of its 3 values exactly the same points were removed." If several parameters are swept, cells
/// that differ only in this parameter are compared. The sentence names the sequences unless it
/// holds for all. A parameter is left out if no two of its values were run.
std::vector<std::string> flat_sweeps(const RunResults& results, const Sweep& sweep);

/// The same for all sweeps of a run: "sweep of raymoval:offline over tau0: tau0 made ...".
std::vector<std::string> flat_sweeps(const RunResults& results);

}  // namespace raymoval
