// SPDX-License-Identifier: MIT
#pragma once

namespace raymoval {

/// The commit that this program was built from, 40 hexadecimal digits; "unknown" without git.
const char* build_commit();

/// "clean" if the compiled sources are those of the commit, "changed" if not, or "unknown".
const char* build_tree();

}  // namespace raymoval
