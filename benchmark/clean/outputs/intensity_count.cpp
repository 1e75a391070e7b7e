// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/intensity_count.h"

#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kLargest = 65535.0;

}  // namespace

void IntensityCount::add(const PointRecords& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double shown = rows.value(i, shown_.field) * scale_;
    if (!(shown > 0.0)) continue;  // Zeros, and what is no number.
    ++positive_;
    if (shown < 1.0) ++faint_;
    if (shown > kLargest + 0.5) ++too_large_;
  }
}

std::vector<std::string> IntensityCount::remarks(const std::string& option) const {
  const std::string exact = "'" + shown_.exact + "' has them as they are.";
  std::vector<std::string> remarks;
  if (2 * faint_ > positive_) {
    remarks.push_back(option + ": " + grouped_text(faint_) + " of " + grouped_text(positive_) +
                      " intensities lie between 0 and 1" +
                      (scale_ == 1.0 ? "" : " after --intensity-scale") +
                      ". LAS shows whole numbers up to 65,535, so viewers show these as 0 or 1; " +
                      exact + " --intensity-scale 65535 spreads values from 0 to 1.");
  }
  if (too_large_ > 0) {
    remarks.push_back(option + ": " + counted_text(too_large_, "point") +
                      " with an intensity of more than 65,535" +
                      (scale_ == 1.0 ? "" : " after --intensity-scale") +
                      " will look as if it were 65,535; " + exact +
                      " Choose a smaller --intensity-scale.");
  }
  return remarks;
}

}  // namespace raymoval
