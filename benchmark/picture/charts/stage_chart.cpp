// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/picture/charts/charts.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kWidth = 900.0;
constexpr double kMargin = 16.0;
constexpr double kTop = 44.0;
constexpr double kTotal = 90.0;  ///< Room for "12,345.6 ms" beside the longest bar.
constexpr double kBar = 16.0;
constexpr double kLine = 17.0;

struct Stage {
  std::string name;
  double ms = 0.0;  ///< Per scan.
};

struct Bar {
  std::string method;
  std::vector<Stage> stages;
  double total_ms = 0.0;
  double length_ms = 0.0;  ///< Sum of the stages: more than the total if stages overlap.
};

const Colour kOther{140, 140, 140};

Bar bar_of(const MethodTimes& times) {
  const double scans = static_cast<double>(std::max<std::size_t>(times.scans, 1));
  Bar bar{times.cell, {}, 1000.0 * times.seconds / scans, 0.0};
  for (const auto& [name, seconds] : times.stages) {
    bar.stages.push_back({name, 1000.0 * seconds / scans});
    bar.length_ms += bar.stages.back().ms;
  }
  if (bar.total_ms > bar.length_ms) {
    bar.stages.push_back({"other", bar.total_ms - bar.length_ms});
    bar.length_ms = bar.total_ms;
  }
  return bar;
}

std::string ms_text(double ms) {
  return fixed_text(ms, ms < 10.0 ? 2 : 1) + " ms";
}

/// Each bar starts with the first colour, because each method has its own stages; no colour occurs
/// twice in a bar.
Colour stage_colour(const Bar& bar, std::size_t stage) {
  if (bar.stages[stage].name == "other") return kOther;
  return distinct_colours(bar.stages.size())[stage];
}

/// The stages' names and times below a bar, in lines. @return their height
double draw_names(Chart& chart, const Bar& bar, double y) {
  double x = kMargin, top = y;
  for (std::size_t i = 0; i < bar.stages.size(); ++i) {
    const std::string text = bar.stages[i].name + " " + ms_text(bar.stages[i].ms);
    const double width = text_width(text) + 24.0;
    if (x + width > kWidth - kMargin && x > kMargin) {
      x = kMargin;
      top += kLine;
    }
    chart.rectangle(x, top, 10.0, 10.0, stage_colour(bar, i), text);
    chart.text(x + 14.0, top + 9.0, text, "soft");
    x += width;
  }
  return top - y + kLine;
}

/// @return the height it takes
double draw_bar(Chart& chart, const Bar& bar, double pixels_per_ms, double y) {
  chart.text(kMargin, y + 12.0, bar.method, "bold");
  const double top = y + 18.0;
  double done = 0.0;
  for (std::size_t i = 0; i < bar.stages.size(); ++i) {
    const double width = bar.stages[i].ms * pixels_per_ms;
    chart.rectangle(kMargin + done, top, width, kBar, stage_colour(bar, i),
                    bar.method + ", " + bar.stages[i].name + ": " + ms_text(bar.stages[i].ms));
    done += width;
  }
  chart.text(kMargin + done + 6.0, top + 12.0, ms_text(bar.total_ms));
  return 18.0 + kBar + 8.0 + draw_names(chart, bar, top + kBar + 8.0) + 10.0;
}

}  // namespace

Chart stage_chart(const RunResults& results) {
  std::vector<Bar> bars;
  double most = 0.0;
  for (const MethodTimes& times : results.times) {
    if (results.is_swept(times.cell)) continue;
    bars.push_back(bar_of(times));
    most = std::max(most, bars.back().length_ms);
  }
  if (bars.empty()) return {};
  Chart chart("stages", "Milliseconds per scan by stage, without reading files",
              "A bar for each method, made of its stages in the order in which they run.");
  const bool overlap = std::any_of(bars.begin(), bars.end(),
                                   [](const Bar& bar) { return bar.length_ms > bar.total_ms; });
  if (overlap) {
    chart.text(kMargin, 38.0,
               "Stages that ran on several threads at once are summed over them; the number beside "
               "a bar is the wall time.",
               "soft");
  }
  const double pixels_per_ms = (kWidth - 2.0 * kMargin - kTotal) / (most > 0.0 ? most : 1.0);
  double y = kTop + (overlap ? 14.0 : 0.0);
  for (const Bar& bar : bars) y += draw_bar(chart, bar, pixels_per_ms, y);
  chart.set_size(kWidth, y + 4.0);
  return chart;
}

}  // namespace raymoval
