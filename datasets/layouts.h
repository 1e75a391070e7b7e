// SPDX-License-Identifier: MIT
#pragma once

#include <list>
#include <string>

#include "datasets/layout.h"

namespace raymoval {

/// All layouts, in the order in which they are tried for a path.
const std::list<Layout>& layouts();

/// Adds a layout. It is tried before other layouts, but after scenes, whose names take precedence
/// over folders. Call this before other threads open sequences.
/// @throws UsageError if there is a layout of this name
void register_layout(Layout layout);

/// The first layout that recognises `path`. Null if none does.
/// @throws DataError if the path cannot be accessed
const Layout* recognised_layout(const std::string& path);

/// The layout of `sequence`; an empty layout if it was not opened by one.
const Layout& layout_of(const Sequence& sequence);

}  // namespace raymoval
