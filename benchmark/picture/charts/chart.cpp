// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

/// Each colour is written twice: programs that do not support custom properties use the first.
constexpr const char* kStyle =
    R"(:root{--chart-ink:#1a1a1a;--chart-soft:#595959;--chart-line:#d4d4d4;--chart-ground:#ffffff}
@media (prefers-color-scheme:dark){
:root{--chart-ink:#f0f0f0;--chart-soft:#b4b4b4;--chart-line:#4a4a4a;--chart-ground:#1c1c1c}}
.raymoval-chart{font-family:'Helvetica Neue',Arial,'DejaVu Sans',sans-serif;font-size:12px}
.raymoval-chart .ground{fill:#ffffff;fill:var(--chart-ground)}
.raymoval-chart text{fill:#1a1a1a;fill:var(--chart-ink)}
.raymoval-chart .soft{fill:#595959;fill:var(--chart-soft)}
.raymoval-chart .bold{font-weight:bold}
.raymoval-chart .middle{text-anchor:middle}
.raymoval-chart .end{text-anchor:end}
.raymoval-chart .small{font-size:10px}
.raymoval-chart .axis{stroke:#595959;stroke:var(--chart-soft);fill:none}
.raymoval-chart .grid{stroke:#d4d4d4;stroke:var(--chart-line);fill:none}
.raymoval-chart .iso{stroke:#595959;stroke:var(--chart-soft);stroke-dasharray:2 3;fill:none}
.raymoval-chart .front{stroke:#595959;stroke:var(--chart-soft);stroke-width:1.5;fill:none}
.raymoval-chart .joined{stroke-width:1.5;fill:none}
.raymoval-chart .bar{stroke-width:7;stroke-opacity:.4;fill:none}
.raymoval-chart .mark{stroke:#ffffff;stroke:var(--chart-ground);stroke-width:1}
)";

std::string points_text(const std::vector<ChartPoint>& points) {
  std::string text;
  for (const ChartPoint& point : points) {
    text += length_text(point.x) + "," + length_text(point.y) + " ";
  }
  return text;
}

}  // namespace

SeriesStyle series_style(std::size_t index, std::size_t count) {
  return {distinct_colours(count)[index], static_cast<int>(index % 5)};
}

std::string chart_style() {
  return kStyle;
}

std::string length_text(double value) {
  const double rounded = std::round(value * 100.0) / 100.0;
  return number_text(rounded == 0.0 ? 0.0 : rounded);  // Never "-0".
}

std::string ms_text(double ms) {
  if (ms >= 1000.0) return fixed_text(ms / 1000.0, 2) + " s";
  return fixed_text(ms, ms < 10.0 ? 2 : 1) + " ms";
}

double text_width(const std::string& text) {
  return 6.8 * static_cast<double>(character_count(text));
}

Chart::Chart(const std::string& name, const std::string& title, const std::string& description)
    : name_("chart-" + id_text(name)), title_(title), description_(description) {
  text(16.0, 22.0, title, "bold");
}

void Chart::text(double x, double y, const std::string& content, const std::string& look) {
  elements_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\">{}</text>\n", look, length_text(x),
                           length_text(y), xml_escaped(content));
}

void Chart::text_upwards(double x, double y, const std::string& content) {
  elements_ +=
      fmt::format("<text class=\"middle\" transform=\"translate({} {}) rotate(-90)\">{}</text>\n",
                  length_text(x), length_text(y), xml_escaped(content));
}

void Chart::line(const std::vector<ChartPoint>& points, const std::string& look,
                 std::optional<Colour> colour) {
  const std::string stroke = colour ? " stroke=\"" + colour_text(*colour) + "\"" : "";
  elements_ +=
      fmt::format("<polyline class=\"{}\"{} points=\"{}\"/>\n", look, stroke, points_text(points));
}

void Chart::marker(const ChartPoint& at, const SeriesStyle& look, const std::string& hint) {
  static const std::vector<ChartPoint> kCorners[] = {
      {},
      {{-4.4, -4.4}, {4.4, -4.4}, {4.4, 4.4}, {-4.4, 4.4}},
      {{0.0, -6.2}, {6.2, 0.0}, {0.0, 6.2}, {-6.2, 0.0}},
      {{0.0, -5.8}, {5.6, 4.2}, {-5.6, 4.2}},
      {{0.0, 5.8}, {-5.6, -4.2}, {5.6, -4.2}}};
  std::vector<ChartPoint> points = kCorners[look.shape];
  for (ChartPoint& point : points) point = {at.x + point.x, at.y + point.y};
  const std::string place = points.empty() ? fmt::format("cx=\"{}\" cy=\"{}\" r=\"5\"",
                                                         length_text(at.x), length_text(at.y))
                                           : fmt::format("points=\"{}\"", points_text(points));
  elements_ += fmt::format("<{0} class=\"mark\" fill=\"{1}\" {2}><title>{3}</title></{0}>\n",
                           points.empty() ? "circle" : "polygon", colour_text(look.colour), place,
                           xml_escaped(hint));
}

void Chart::set_size(double width, double height) {
  size_ = {std::max(width, text_width(title_) * 1.1 + 32.0), height};
}

void Chart::add_note(const std::string& line) {
  text(16.0, size_.y + 4.0, line, "soft");
  set_size(std::max(size_.x, text_width(line) + 32.0), size_.y + 20.0);
}

std::string Chart::svg(const std::string& style) const {
  if (empty()) return "";
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"raymoval-chart\" role=\"img\" "
      "aria-labelledby=\"{0}-title {0}-desc\" width=\"{1}\" height=\"{2}\" "
      "viewBox=\"0 0 {1} {2}\">\n<title id=\"{0}-title\">{3}</title>\n"
      "<desc id=\"{0}-desc\">{4}</desc>\n",
      name_, length_text(size_.x), length_text(size_.y), xml_escaped(title_),
      xml_escaped(description_));
  if (!style.empty()) svg += "<style>\n" + style + "</style>\n";
  return svg + "<rect class=\"ground\" width=\"100%\" height=\"100%\"/>\n" + elements_ + "</svg>\n";
}

}  // namespace raymoval
