// SPDX-License-Identifier: MIT
#pragma once

#include <list>
#include <string>

#include "datasets/layout.h"

namespace raymoval {

/// All layouts, in the order in which they are asked whether they recognise a path.
const std::list<Layout>& layouts();

/// Adds a layout of a program's or a test's own. It is asked before the others, but after scenes,
/// whose names stand above folders. To be called before sequences are opened in other threads.
/// @throws UsageError if there is a layout of this name
void register_layout(Layout layout);

/// The first layout that recognises `path`. Null if none does.
/// @throws DataError if the path cannot be looked at
const Layout* recognised_layout(const std::string& path);

/// The layout that `sequence` was opened by. One that no layout opened has a layout without facts.
const Layout& layout_of(const Sequence& sequence);

}  // namespace raymoval
