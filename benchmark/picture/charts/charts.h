// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/picture/charts/chart.h"
#include "benchmark/result/results.h"

namespace raymoval {

// As SVG, each chart is one element of well-formed XML. Its text is text, and it has a <title> and
// a <desc> for assistive programs; each marker or bar has a <title> with its values. The same
// results give the same bytes. Controls are left out.

/// Shows the rate of kept points (upwards) against the rate of removed points (to the right). Each
/// sequence has a panel. Lines of equal headline rate are drawn if it is the harmonic mean of both.
/// A line joins the points of a sweep. The chart is empty if no cell has both rates.
/// @param protocol its name in the run
Chart pr_rr_chart(const RunResults& results, const std::string& protocol);

/// Shows the share of moving points (upwards) against the mean confidence (to the right): a marker
/// for each bin with points, a line for each method with confidences. A dotted diagonal marks
/// confidences that equal the share. The chart is empty if no method has confidences.
Chart reliability_chart(const RunResults& results);

/// Shows, for each sweep over one parameter that is a number, the rates over that parameter: plots
/// of the rate of kept points, the rate of removed points and the headline rate, with a line for
/// each sequence and one for the mean of several sequences. The chart is empty if there is no such
/// sweep with a result.
/// @param protocol its name in the run
Chart sweep_chart(const RunResults& results, const std::string& protocol);

/// Shows the mean of the headline rate over the sequences against milliseconds per scan
/// (logarithmic). A line joins the methods that no other method beats in both. The chart is empty
/// if no method has both.
/// @param protocol its name in the run
Chart accuracy_time_chart(const RunResults& results, const std::string& protocol);

/// Shows the rates of each method on a sequence, the best method first: a marker at each rate, a
/// bar over its interval. The chart is empty if no method has an interval of the headline rate.
/// @param protocol its name in the run
Chart interval_chart(const RunResults& results, const std::string& protocol,
                     const std::string& sequence);

/// Shows the share of moving points that are removed and that of static points that are kept on a
/// sequence: lines over range and over time, a row for each class. Parts with fewer than
/// `kNamedClassPoints` points are left out. The chart is empty if no method has columns.
Chart parts_chart(const RunResults& results, const std::string& sequence);

}  // namespace raymoval
