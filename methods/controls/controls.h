// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "methods/registry.h"

namespace raymoval {

/// Controls: answers whose score is known beforehand, run in every suite to check the scoring.
MethodEntry noop_entry();        ///< Removes nothing: PR 100, RR 0.
MethodEntry remove_all_entry();  ///< Removes everything: PR 0, RR 100.

/// Removes exactly the points labelled moving: RR 100. Its entry cannot be made from a
/// configuration alone, since methods have no labels: whoever has them uses `make_replay`.
MethodEntry oracle_entry();

/// Answers with the masks that `mask_of` gives, such as those of the labels or of a stored run.
std::unique_ptr<Remover> make_replay(std::function<Mask(const Scan&)> mask_of);

}  // namespace raymoval
