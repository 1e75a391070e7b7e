// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/result/results.h"

namespace raymoval {

/// Where a chart is to stand.
enum class ChartPlace {
  kFile,  ///< A file of its own, with its style; follows the viewer's light or dark scheme.
  kPage,  ///< Within an HTML page that has `chart_style()` in a style sheet.
  kPrint  ///< To be drawn on paper or as pixels: light, without custom properties.
};

/// The charts' style for a page. Colours of text, lines and ground are the custom properties
/// --chart-ink, --chart-soft, --chart-line and --chart-ground: a page with a switch between light
/// and dark sets them again; without that they follow prefers-color-scheme.
std::string chart_style();

// Each chart is one <svg> element, well-formed XML, text as text, with <title> and <desc>, which
// assistive programs read; a marker or bar tells its values in a <title> of its own. The same
// results give the same bytes. Controls are left out.

/// What is kept (upwards) against what is removed (to the right), a panel for each sequence. There
/// are lines of equal headline rate if that is the harmonic mean of both. The points of a sweep are
/// joined. Empty text if no cell has both rates.
/// @param protocol its name in the run
std::string pr_rr_chart(const RunResults& results, const std::string& protocol,
                        ChartPlace place = ChartPlace::kFile);

/// Milliseconds per scan of each method by stage, as stacked bars. Empty text without times.
std::string stage_chart(const RunResults& results, ChartPlace place = ChartPlace::kFile);

/// The mean of the headline rate over the sequences against milliseconds per scan (logarithmic),
/// with the line of methods that no other one beats in both. Empty text if no method has both.
/// @param protocol its name in the run
std::string accuracy_time_chart(const RunResults& results, const std::string& protocol,
                                ChartPlace place = ChartPlace::kFile);

}  // namespace raymoval
