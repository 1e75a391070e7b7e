// SPDX-License-Identifier: MIT
#include "benchmark/picture/charts/chart_drawing.h"

#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "benchmark/picture/canvas/canvas.h"
#include "benchmark/picture/canvas/font.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

/// A custom property of the charts' style, by its value in light and in dark.
struct ChartColour {
  std::string_view name;
  Colour light, dark;
};
constexpr ChartColour kChartColours[] = {{"--chart-ink", kInk, {0xf0, 0xf0, 0xf0}},
                                         {"--chart-soft", kSoftInk, {0xb4, 0xb4, 0xb4}},
                                         {"--chart-line", {0xd4, 0xd4, 0xd4}, {0x4a, 0x4a, 0x4a}},
                                         {"--chart-ground", kPaper, {0x1c, 0x1c, 0x1c}}};

/// What an element or a class means: CSS for SVG, and read by what draws with cairo. The last rule
/// that fits counts.
struct Rule {
  std::string_view selector, declarations;
};
constexpr Rule kRules[] = {
    {"", "font-family:'Helvetica Neue',Arial,'DejaVu Sans',sans-serif;font-size:12px"},
    {".ground", "fill:var(--chart-ground)"},
    {"text", "fill:var(--chart-ink)"},
    {".soft", "fill:var(--chart-soft)"},
    {".bold", "font-weight:bold"},
    {".middle", "text-anchor:middle"},
    {".end", "text-anchor:end"},
    {".small", "font-size:10px"},
    {".axis", "stroke:var(--chart-soft);fill:none"},
    {".grid", "stroke:var(--chart-line);fill:none"},
    {".iso", "stroke:var(--chart-soft);stroke-dasharray:2 3;fill:none"},
    {".front", "stroke:var(--chart-soft);stroke-width:1.5;fill:none"},
    {".joined", "stroke-width:1.5;fill:none"},
    {".mark", "stroke:var(--chart-ground);stroke-width:1"}};

/// "--chart-ink:#1a1a1a;--chart-soft:#595959" and so on.
std::string declarations(bool dark) {
  std::vector<std::string> all;
  for (const ChartColour& colour : kChartColours) {
    const auto [red, green, blue] = dark ? colour.dark : colour.light;
    all.push_back(fmt::format("{}:#{:02x}{:02x}{:02x}", colour.name, red, green, blue));
  }
  return join(all, ";");
}

/// The values of CSS properties for the names of an element and classes.
std::map<std::string_view, std::string_view> style_of(const std::string& names) {
  const std::vector<std::string_view> known = split_blanks(names);
  std::map<std::string_view, std::string_view> style;
  for (const auto& [selector, declarations] : kRules) {
    const std::string_view name = selector.substr(selector.starts_with('.') ? 1 : 0);
    if (!name.empty() && std::find(known.begin(), known.end(), name) == known.end()) continue;
    for (const std::string_view declaration : split(declarations, ';')) {
      const std::vector<std::string_view> parts = split(declaration, ':');
      style[parts[0]] = parts[1];
    }
  }
  return style;
}

/// The light colour of a value such as var(--chart-ink).
Colour light_colour(std::string_view value) {
  for (const ChartColour& colour : kChartColours) {
    if (value.find(colour.name) != std::string_view::npos) return colour.light;
  }
  return {};
}

/// For each kind of shape. 0: class and colour, 1: content, 2: points, 3 ...: numbers.
constexpr const char* kElements[] = {
    "<text{0} x=\"{3}\" y=\"{4}\">{1}</text>\n",
    "<text{0} transform=\"translate({3} {4}) rotate(-90)\">{1}</text>\n",
    "<line{0} x1=\"{3}\" y1=\"{4}\" x2=\"{5}\" y2=\"{6}\"/>\n",
    "<polyline{0} points=\"{2}\"/>\n",
    "<rect{0} x=\"{3}\" y=\"{4}\" width=\"{5}\" height=\"{6}\"><title>{1}</title></rect>\n",
    "<circle{0} cx=\"{3}\" cy=\"{4}\" r=\"5\"><title>{1}</title></circle>\n",
    "<polygon{0} points=\"{2}\"><title>{1}</title></polygon>\n"};

std::string svg_of(const ChartShape& shape) {
  std::string classes = " class=\"" + shape.look + "\"", points;
  if (shape.colour) {
    classes += shape.kind == ShapeKind::kPolyline ? " stroke=\"" : " fill=\"";
    classes += colour_text(*shape.colour) + "\"";
  }
  for (const ChartPoint& point : shape.points) {
    points += length_text(point.x) + "," + length_text(point.y) + " ";
  }
  const ChartPoint first = shape.points.front(), last = shape.points.back();
  return fmt::format(fmt::runtime(kElements[static_cast<int>(shape.kind)]), classes,
                     xml_escaped(shape.content), points, length_text(first.x), length_text(first.y),
                     length_text(last.x), length_text(last.y));
}

void draw_text(cairo_t* context, const ChartShape& shape) {
  const std::string text = printable_text(shape.content);
  auto style = style_of("text " + shape.look);
  const std::string_view size = style["font-size"];  // "12px".
  choose_font(context, parse_number<int>(size.substr(0, size.find('p'))).value(),
              style["font-weight"] == "bold");
  cairo_text_extents_t extents{};  // Is left alone if there is no memory.
  cairo_text_extents(context, text.c_str(), &extents);
  const std::string_view anchor = style["text-anchor"];
  const double before = anchor == "middle" ? 0.5 : anchor == "end" ? 1.0 : 0.0;
  set_source(context, light_colour(style["fill"]));
  cairo_save(context);
  cairo_translate(context, shape.points.front().x, shape.points.front().y);
  if (shape.kind == ShapeKind::kTextUpwards) cairo_rotate(context, -std::numbers::pi / 2.0);
  cairo_move_to(context, -before * extents.x_advance, 0.0);
  cairo_show_text(context, text.c_str());
  cairo_restore(context);
}

void draw_path(cairo_t* context, const ChartShape& shape) {
  const ChartPoint first = shape.points.front(), last = shape.points.back();
  cairo_new_path(context);
  if (shape.kind == ShapeKind::kRectangle) {
    cairo_rectangle(context, first.x, first.y, last.x, last.y);
  } else if (shape.kind == ShapeKind::kCircle) {
    cairo_arc(context, first.x, first.y, 5.0, 0.0, 2.0 * std::numbers::pi);
  } else {
    for (const ChartPoint& point : shape.points) cairo_line_to(context, point.x, point.y);
  }
  if (shape.kind != ShapeKind::kLine && shape.kind != ShapeKind::kPolyline) {
    cairo_close_path(context);
    set_source(context, shape.colour.value());
    cairo_fill_preserve(context);
  }
  auto style = style_of(shape.look);
  std::vector<double> dashes;
  for (const std::string_view length : split_blanks(style["stroke-dasharray"])) {
    dashes.push_back(parse_number<double>(length).value());
  }
  cairo_set_dash(context, dashes.data(), static_cast<int>(dashes.size()), 0.0);
  cairo_set_line_width(context, parse_number<double>(style["stroke-width"]).value_or(1.0));
  set_source(context,
             style.contains("stroke") ? light_colour(style["stroke"]) : shape.colour.value());
  cairo_stroke(context);
}

}  // namespace

SeriesLook series_look(std::size_t index, std::size_t count) {
  return {distinct_colours(count)[index], static_cast<int>(index % 5)};
}

std::string chart_style() {
  std::string css = ":root{" + declarations(false) +
                    "}\n@media (prefers-color-scheme:dark){:root{" + declarations(true) + "}}\n";
  for (const auto& [selector, rule] : kRules) {
    css += fmt::format(".raymoval-chart{}{}{{{}}}\n", selector.empty() ? "" : " ", selector, rule);
  }
  return css;
}

std::string length_text(double value) {
  const double rounded = std::round(value * 100.0) / 100.0;
  return number_text(rounded == 0.0 ? 0.0 : rounded);  // Never "-0".
}

double text_width(const std::string& text) {
  return 6.8 * static_cast<double>(character_count(text));
}

ChartDrawing::ChartDrawing(const std::string& name, const std::string& title,
                           const std::string& description)
    : name_("chart-" + id_text(name)), title_(title), description_(description) {}

void ChartDrawing::marker(double x, double y, const SeriesLook& look, const std::string& hint) {
  static const std::vector<ChartPoint> kCorners[] = {
      {{0.0, 0.0}},
      {{-4.4, -4.4}, {4.4, -4.4}, {4.4, 4.4}, {-4.4, 4.4}},
      {{0.0, -6.2}, {6.2, 0.0}, {0.0, 6.2}, {-6.2, 0.0}},
      {{0.0, -5.8}, {5.6, 4.2}, {-5.6, 4.2}},
      {{0.0, 5.8}, {-5.6, -4.2}, {5.6, -4.2}}};
  std::vector<ChartPoint> points = kCorners[look.shape];
  for (ChartPoint& point : points) point = {x + point.x, y + point.y};
  shapes_.push_back({look.shape == 0 ? ShapeKind::kCircle : ShapeKind::kPolygon, "mark",
                     std::move(points), hint, look.colour});
}

std::string ChartDrawing::svg(const std::string& style) const {
  if (empty()) return "";
  const std::string width = length_text(size_.x), height = length_text(size_.y);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"raymoval-chart\" role=\"img\" "
      "aria-labelledby=\"{0}-title {0}-desc\" width=\"{1}\" height=\"{2}\" "
      "viewBox=\"0 0 {1} {2}\">\n<title id=\"{0}-title\">{3}</title>\n"
      "<desc id=\"{0}-desc\">{4}</desc>\n",
      name_, width, height, xml_escaped(title_), xml_escaped(description_));
  if (!style.empty()) svg += "<style>\n" + style + "</style>\n";
  svg += fmt::format("<rect class=\"ground\" width=\"{}\" height=\"{}\"/>\n", width, height);
  for (const ChartShape& shape : shapes_) svg += svg_of(shape);
  return svg + "</svg>\n";
}

void ChartDrawing::draw(cairo_t* context, double scale) const {
  cairo_scale(context, scale, scale);
  cairo_set_miter_limit(context, 4.0);  // As in SVG.
  set_source(context, light_colour(style_of("ground")["fill"]));
  cairo_paint(context);
  for (const ChartShape& shape : shapes_) {
    const bool is_text = shape.kind == ShapeKind::kText || shape.kind == ShapeKind::kTextUpwards;
    (is_text ? draw_text : draw_path)(context, shape);
  }
}

}  // namespace raymoval
