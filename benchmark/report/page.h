// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/report/sections.h"
#include "benchmark/run/kept_run.h"
#include "core/progress.h"

namespace raymoval {

/// What a page is made of besides the results.
struct PageRequest {
  const KeptRun* run = nullptr;
  ReportContent content;
  const Comparison* comparison = nullptr;  ///< With a reference; may be null.
  std::string reference;                   ///< Its name.
  const MethodRegistry* methods = nullptr;
  bool with_points = true;       ///< Whether there is a 3-D view.
  std::size_t points = 1000000;  ///< At most so many in the whole page.
  bool points_needed = false;    ///< Whether a sequence that cannot be opened again ends it.
  int threads = 1;
  Progress* progress = nullptr;
  const std::atomic<bool>* cancel = nullptr;
};

/// A page, and what is missing in it.
struct Page {
  std::string html;
  std::vector<std::string> warnings;  ///< Such as a sequence whose points are gone.
};

/// The report as one HTML file that needs nothing else. @throws Cancelled; DataError where
/// `points_needed`
Page make_page(const PageRequest& request);

}  // namespace raymoval
