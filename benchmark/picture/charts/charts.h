// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/result/results.h"

namespace raymoval {

/// Where a chart will be shown.
enum class ChartPlace {
  kFile,  ///< In a file of its own, with its style. It follows the viewer's light or dark scheme.
  kPage,  ///< In an HTML page whose style sheet holds `chart_style()`.
  kPrint  ///< On paper or as pixels: light, and without CSS custom properties.
};

/// The charts' style for a page. The colours of text, lines and ground are the custom properties
/// --chart-ink, --chart-soft, --chart-line and --chart-ground. They follow prefers-color-scheme; a
/// page with a switch between light and dark sets them itself.
std::string chart_style();

// Each chart is one <svg> element of well-formed XML. Its text is text, and it has a <title> and a
// <desc> for assistive programs; each marker or bar has a <title> with its values. The same results
// give the same bytes. Controls are left out.

/// Shows what is kept (upwards) against what is removed (to the right). Each sequence has a panel.
/// There are lines of equal headline rate if that is the harmonic mean of both, and a line joins
/// the points of a sweep. The text is empty if no cell has both rates.
/// @param protocol its name in the run
std::string pr_rr_chart(const RunResults& results, const std::string& protocol,
                        ChartPlace place = ChartPlace::kFile);

/// Shows the milliseconds per scan of each method by stage, as stacked bars. The text is empty if
/// there are no times.
std::string stage_chart(const RunResults& results, ChartPlace place = ChartPlace::kFile);

/// Shows which share of the points moves (upwards) against the mean confidence that was said of
/// them (to the right), a marker for each bin with points, a line for each method that was asked. A
/// dotted diagonal is where what is said comes true. The text is empty if no method was asked.
std::string reliability_chart(const RunResults& results, ChartPlace place = ChartPlace::kFile);

/// Shows, for each sweep over one parameter that is a number, the rates over that parameter: a plot
/// for what is kept, what is removed and the headline rate, a line for each sequence, and one for
/// the mean of several. The text is empty if there is no such sweep with a result.
/// @param protocol its name in the run
std::string sweep_chart(const RunResults& results, const std::string& protocol,
                        ChartPlace place = ChartPlace::kFile);

/// Shows the mean of the headline rate over the sequences against milliseconds per scan
/// (logarithmic). A line joins the methods that no other one beats in both. The text is empty if no
/// method has both.
/// @param protocol its name in the run
std::string accuracy_time_chart(const RunResults& results, const std::string& protocol,
                                ChartPlace place = ChartPlace::kFile);

}  // namespace raymoval
