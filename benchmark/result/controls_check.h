// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/cell.h"

namespace raymoval {

/// Compares the controls' rates with what they must be: noop PR 100 RR 0 (SA 100 DA 0), remove-all
/// PR 0 RR 100 (SA 0 DA 100), oracle RR 100 (SA 100). Undefined rates are passed over.
/// @return a sentence for each that is off or did not finish; empty if all is well
std::vector<std::string> check_controls(const std::vector<Cell>& cells);

}  // namespace raymoval
