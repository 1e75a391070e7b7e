// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/report/scene.h"
#include "benchmark/report/sections.h"
#include "benchmark/run/folder/kept_run.h"
#include "core/progress.h"

namespace raymoval {

/// The content of a page.
struct PageRequest {
  const KeptRun* run = nullptr;
  std::vector<OutsideColumn> published;  ///< Papers' rows; may be empty.
  const MethodRegistry* methods = nullptr;
  bool with_points = true;       ///< Whether there is a 3-D view.
  std::size_t points = 1000000;  ///< The whole page has at most this many points.
  bool points_needed = false;    ///< If true, a sequence that cannot be opened again is an error.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
};

/// A page, and its missing parts.
struct Page {
  std::string html;
  std::vector<std::string> warnings;  ///< Missing parts, such as a sequence's points.
};

/// Makes the report as one self-contained HTML file.
/// @throws Cancelled; DataError if `points_needed` and a sequence cannot be opened
Page make_page(const PageRequest& request);

/// A cleaned map as one self-contained HTML file in which a reader corrects it and exports the
/// corrections (see `Edits`), and some lines of text below it.
/// @param scene of a `MapSceneBuilder`
std::string map_page(const Scene& scene, const std::string& title,
                     const std::vector<std::string>& lines);

}  // namespace raymoval
