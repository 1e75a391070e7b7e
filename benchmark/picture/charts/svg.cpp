// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/svg.h"

#include <cmath>

#include "benchmark/tables/text/text_table.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

/// A custom property of the charts' style, by its value in light and in dark.
struct ChartColour {
  const char* name;
  const char* light;
  const char* dark;
};
constexpr ChartColour kChartColours[] = {{"--chart-ink", "#1a1a1a", "#f0f0f0"},
                                         {"--chart-soft", "#595959", "#b4b4b4"},
                                         {"--chart-line", "#d4d4d4", "#4a4a4a"},
                                         {"--chart-ground", "#ffffff", "#1c1c1c"}};

/// "--chart-ink:#1a1a1a;--chart-soft:#595959" and so on.
std::string declarations(bool dark) {
  std::vector<std::string> all;
  for (const ChartColour& colour : kChartColours) {
    all.push_back(std::string(colour.name) + ":" + (dark ? colour.dark : colour.light));
  }
  return join(all, ";");
}

constexpr const char* kRules =
    R"css(.raymoval-chart{font-family:'Helvetica Neue',Arial,'DejaVu Sans',sans-serif;font-size:12px}
.raymoval-chart .ground{fill:var(--chart-ground)}
.raymoval-chart text{fill:var(--chart-ink)}
.raymoval-chart .soft{fill:var(--chart-soft)}
.raymoval-chart .bold{font-weight:bold}
.raymoval-chart .middle{text-anchor:middle}
.raymoval-chart .end{text-anchor:end}
.raymoval-chart .small{font-size:10px}
.raymoval-chart .axis{stroke:var(--chart-soft);fill:none}
.raymoval-chart .grid{stroke:var(--chart-line);fill:none}
.raymoval-chart .iso{stroke:var(--chart-soft);stroke-dasharray:2 3;fill:none}
.raymoval-chart .front{stroke:var(--chart-soft);stroke-width:1.5;fill:none}
.raymoval-chart .joined{stroke-width:1.5;fill:none}
.raymoval-chart .mark{stroke:var(--chart-ground);stroke-width:1}
)css";

/// The rules with the colours of the light scheme in them, for programs without custom properties.
std::string print_style() {
  std::string css = kRules;
  for (const ChartColour& colour : kChartColours) {
    const std::string use = "var(" + std::string(colour.name) + ")";
    for (std::size_t at = css.find(use); at != std::string::npos; at = css.find(use, at)) {
      css.replace(at, use.size(), colour.light);
    }
  }
  return css;
}

std::string shape_path(double x, double y, int shape) {
  const auto at = [&](double dx, double dy) { return point_text(x + dx, y + dy); };
  switch (shape) {
    case 1:
      return at(-4.4, -4.4) + at(4.4, -4.4) + at(4.4, 4.4) + at(-4.4, 4.4);
    case 2:
      return at(0, -6.2) + at(6.2, 0) + at(0, 6.2) + at(-6.2, 0);
    case 3:
      return at(0, -5.8) + at(5.6, 4.2) + at(-5.6, 4.2);
    default:
      return at(0, 5.8) + at(-5.6, -4.2) + at(5.6, -4.2);
  }
}

}  // namespace

SeriesLook series_look(std::size_t index, std::size_t count) {
  return {distinct_colours(count)[index], static_cast<int>(index % 5)};
}

std::string chart_style() {
  return ":root{" + declarations(false) + "}\n@media (prefers-color-scheme:dark){:root{" +
         declarations(true) + "}}\n" + kRules;
}

SvgWriter::SvgWriter(const std::string& name, const std::string& title,
                     const std::string& description)
    : name_("chart-" + id_text(name)), title_(title), description_(description) {}

std::string length_text(double value) {
  const double rounded = std::round(value * 100.0) / 100.0;
  return number_text(rounded == 0.0 ? 0.0 : rounded);  // Never "-0".
}

std::string point_text(double x, double y) {
  return length_text(x) + "," + length_text(y) + " ";
}

double text_width(const std::string& text) {
  return 6.8 * static_cast<double>(character_count(text));
}

void SvgWriter::text(double x, double y, const std::string& content, const std::string& look) {
  body_ += "<text class=\"" + look + "\" x=\"" + length_text(x) + "\" y=\"" + length_text(y) +
           "\">" + xml_escaped(content) + "</text>\n";
}

void SvgWriter::text_upwards(double x, double y, const std::string& content) {
  body_ += "<text class=\"middle\" transform=\"translate(" + length_text(x) + " " + length_text(y) +
           ") rotate(-90)\">" + xml_escaped(content) + "</text>\n";
}

void SvgWriter::line(double x0, double y0, double x1, double y1, const std::string& look) {
  body_ += "<line class=\"" + look + "\" x1=\"" + length_text(x0) + "\" y1=\"" + length_text(y0) +
           "\" x2=\"" + length_text(x1) + "\" y2=\"" + length_text(y1) + "\"/>\n";
}

void SvgWriter::polyline(const std::string& points, const std::string& look,
                         const std::string& stroke) {
  body_ += "<polyline class=\"" + look + "\"" +
           (stroke.empty() ? "" : " stroke=\"" + stroke + "\"") + " points=\"" + points + "\"/>\n";
}

void SvgWriter::rectangle(double x, double y, double width, double height, const Colour& colour,
                          const std::string& hint) {
  body_ += "<rect class=\"mark\" fill=\"" + colour_text(colour) + "\" x=\"" + length_text(x) +
           "\" y=\"" + length_text(y) + "\" width=\"" + length_text(width) + "\" height=\"" +
           length_text(height) + "\"><title>" + xml_escaped(hint) + "</title></rect>\n";
}

void SvgWriter::marker(double x, double y, const SeriesLook& look, const std::string& hint) {
  const std::string fill = " class=\"mark\" fill=\"" + colour_text(look.colour) + "\"";
  const std::string title = "<title>" + xml_escaped(hint) + "</title>";
  if (look.shape == 0) {
    body_ += "<circle" + fill + " cx=\"" + length_text(x) + "\" cy=\"" + length_text(y) +
             "\" r=\"5\">" + title + "</circle>\n";
  } else {
    body_ += "<polygon" + fill + " points=\"" + shape_path(x, y, look.shape) + "\">" + title +
             "</polygon>\n";
  }
}

std::string SvgWriter::finish(double width, double height, ChartPlace place) const {
  const std::string size = length_text(width) + "\" height=\"" + length_text(height);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"raymoval-chart\" role=\"img\"";
  svg += " aria-labelledby=\"" + name_ + "-title " + name_ + "-desc\" width=\"" + size +
         "\" viewBox=\"0 0 " + length_text(width) + " " + length_text(height) + "\">\n";
  svg += "<title id=\"" + name_ + "-title\">" + xml_escaped(title_) + "</title>\n";
  svg += "<desc id=\"" + name_ + "-desc\">" + xml_escaped(description_) + "</desc>\n";
  if (place != ChartPlace::kPage) {
    svg +=
        "<style>\n" + (place == ChartPlace::kPrint ? print_style() : chart_style()) + "</style>\n";
  }
  svg += "<rect class=\"ground\" width=\"" + size + "\"/>\n" + body_;
  return svg + "</svg>\n";
}

}  // namespace raymoval
