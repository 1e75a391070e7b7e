// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "methods/method_entry.h"

namespace raymoval {

/// Controls: methods with a known score. They are run in every suite to check the scoring.
MethodEntry noop_entry();        ///< It removes nothing: PR 100, RR 0.
MethodEntry remove_all_entry();  ///< It removes everything: PR 0, RR 100.

/// It removes exactly the points that are labelled moving: RR 100. Its entry cannot make a method
/// from a configuration, because methods get no labels: use `make_replay` with the labels.
MethodEntry oracle_entry();

/// A remover with the masks of `mask_of`, such as those of the labels or of a stored run.
std::unique_ptr<Remover> make_replay(const std::function<Mask(const Scan&)>& mask_of);

}  // namespace raymoval
