// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/tables/table_options.h"
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

/// A stage has the same colour in all bars.
using StageColours = std::map<std::string, Colour>;

StageColours stage_colours(const std::vector<Bar>& bars) {
  std::vector<std::string> names;
  for (const Bar& bar : bars) {
    for (const Stage& stage : bar.stages) add_once(names, stage.name);
  }
  std::erase(names, "other");
  const std::vector<Colour> colours = distinct_colours(names.size());
  StageColours result = {{"other", kOther}};
  for (std::size_t i = 0; i < names.size(); ++i) result[names[i]] = colours[i];
  return result;
}

/// The stages' names and times below a bar, in lines. @return their height
double draw_names(Chart& chart, const Bar& bar, const StageColours& colours, double y) {
  double x = kMargin, top = y;
  for (const Stage& stage : bar.stages) {
    const std::string text = stage.name + " " + ms_text(stage.ms);
    const double width = text_width(text) + 24.0;
    if (x + width > kWidth - kMargin && x > kMargin) {
      x = kMargin;
      top += kLine;
    }
    chart.rectangle(x, top, 10.0, 10.0, colours.at(stage.name), text);
    chart.text(x + 14.0, top + 9.0, text, "soft");
    x += width;
  }
  return top - y + kLine;
}

/// @return the height it takes
double draw_bar(Chart& chart, const Bar& bar, const StageColours& colours, double pixels_per_ms,
                double y) {
  chart.text(kMargin, y + 12.0, bar.method, "bold");
  const double top = y + 18.0;
  double done = 0.0;
  for (const Stage& stage : bar.stages) {
    const double width = stage.ms * pixels_per_ms;
    chart.rectangle(kMargin + done, top, width, kBar, colours.at(stage.name),
                    bar.method + ", " + stage.name + ": " + ms_text(stage.ms));
    done += width;
  }
  chart.text(kMargin + done + 6.0, top + 12.0, ms_text(bar.total_ms));
  return 18.0 + kBar + 8.0 + draw_names(chart, bar, colours, top + kBar + 8.0) + 10.0;
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
  const StageColours colours = stage_colours(bars);
  for (const Bar& bar : bars) y += draw_bar(chart, bar, colours, pixels_per_ms, y);
  chart.set_size(kWidth, y + 4.0);
  return chart;
}

}  // namespace raymoval
