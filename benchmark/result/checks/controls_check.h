// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/result/cell.h"

namespace raymoval {

/// Compares the rates of the controls with the expected values of their protocols. Undefined rates
/// are not checked.
/// @return a sentence for each unexpected rate and for each control that did not finish
std::vector<std::string> check_controls(const std::vector<Cell>& cells);

}  // namespace raymoval
