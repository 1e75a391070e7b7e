// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/cell.h"

namespace raymoval {

/// Compares the rates of the controls with what their protocols say that they must be. A rate that
/// is undefined is not checked.
/// @return a sentence for each rate that is off and each control that did not finish; empty if all
/// is well
std::vector<std::string> check_controls(const std::vector<Cell>& cells);

}  // namespace raymoval
