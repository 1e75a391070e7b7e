// SPDX-License-Identifier: MIT
#include "benchmark/report/page.h"

#include <algorithm>

#include "benchmark/picture/charts/charts.h"
#include "benchmark/report/html.h"
#include "benchmark/report/pack.h"
#include "benchmark/report/page_files.h"
#include "benchmark/report/scene.h"
#include "benchmark/result/removals/reasons.h"
#include "benchmark/suite/suite.h"
#include "benchmark/tables/table_options.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// Scenes for the 3-D view, and messages on missing ones.
struct Points {
  std::vector<std::string> scenes;  ///< Their heads.
  std::vector<std::pair<std::string, std::string>> streams;
  std::vector<std::string> lost;      ///< Problems with the run's own files.
  std::vector<std::string> warnings;  ///< For the user's terminal; these include `lost`.
  /// Names of sequences that could not be opened. The reason is in `warnings` but not in the page,
  /// which may be published: it may quote a path of a foreign run.json.
  std::vector<std::string> unopened;
};

/// The cells whose points are shown; those of the best method come first.
std::vector<SceneCell> scene_cells(const KeptRun& run, const Sequence& sequence,
                                   std::vector<std::string>& warnings) {
  std::vector<const KeptCell*> all = run.cells_of(sequence.name);
  const std::vector<std::string> order = methods_best_first(run.results());
  std::ranges::stable_sort(
      all, {}, [&](const KeptCell* cell) { return std::ranges::find(order, cell->name); });
  std::vector<SceneCell> cells;
  for (const KeptCell* kept : all) {
    if (!kept->has_removals()) continue;
    try {
      cells.push_back({kept->name, kept->control, run.masks(*kept, sequence), kept->removals,
                       read_reason_sentences(kept->removals)});
    } catch (const UnreadableError&) {
      throw;
    } catch (const DataError& error) {
      warnings.push_back(error.what());
    }
  }
  return cells;
}

bool any_kept(const KeptRun& run, const std::string& sequence) {
  const std::vector<const KeptCell*> cells = run.cells_of(sequence);
  return std::any_of(cells.begin(), cells.end(),
                     [](const KeptCell* cell) { return cell->has_removals(); });
}

std::size_t scans_of(const PageRequest& request, const std::string& sequence) {
  const SequenceRecord* known = find_named(request.run->record().run.sequences, sequence);
  return known == nullptr ? 0 : known->data.scans;
}

/// A sequence's share of the page's points, which is its share of the scans.
std::size_t point_limit(const PageRequest& request, const std::vector<std::string>& sequences,
                        const std::string& sequence) {
  double all = 0.0;
  for (const std::string& name : sequences) all += static_cast<double>(scans_of(request, name));
  const double share = static_cast<double>(scans_of(request, sequence)) / std::max(all, 1.0);
  return std::max<std::size_t>(
      1000, static_cast<std::size_t>(share * static_cast<double>(request.points)));
}

void add_scene(const PageRequest& request, const std::string& name, std::size_t limit,
               Points& points) {
  const Sequence sequence =
      request.run->open(name, {request.threads, request.progress, request.cancel});
  std::vector<SceneCell> cells = scene_cells(*request.run, sequence, points.lost);
  if (cells.empty()) return;
  Scene scene = build_scene(sequence, std::move(cells), limit, request.progress);
  constexpr std::size_t kManyPoints = 1000000;
  if (request.points > kManyPoints) ++scene.shift;  // Larger units take less room.
  PackedScene packed = pack_scene(scene, points.scenes.size());
  points.scenes.push_back(std::move(packed.head));
  for (auto& stream : packed.streams) points.streams.push_back(std::move(stream));
}

Points collect_points(const PageRequest& request) {
  Points points;
  std::vector<std::string> sequences;
  for (const std::string& name : request.run->results().sequences) {
    if (any_kept(*request.run, name)) sequences.push_back(name);
  }
  for (const std::string& name : sequences) {
    throw_if_cancelled(request.cancel);
    try {
      add_scene(request, name, point_limit(request, sequences, name), points);
    } catch (const Cancelled&) {
      throw;
    } catch (const UnreadableError&) {
      throw;
    } catch (const Error& error) {  // The rest of the report does not depend on it.
      if (request.points_needed) throw;
      points.warnings.push_back(error.what());
      points.unopened.push_back(name);
    }
  }
  points.warnings.insert(points.warnings.begin(), points.lost.begin(), points.lost.end());
  return points;
}

/// A view's file with the controls that all views have.
std::string view_html(const char* name) {
  constexpr std::string_view kPlace = "<!-- scans.html -->";
  std::string html(page_file(name));
  return html.replace(html.find(kPlace), kPlace.size(), page_file("scans.html"));
}

std::string points_html(const PageRequest& request, const Points& points) {
  std::string html;
  for (const std::string& warning : points.lost) {
    html += "<p class=\"bad\">" + html_text(warning) + "</p>\n";
  }
  for (const std::string& name : points.unopened) {
    html += "<p class=\"bad\">" +
            html_text("The points of " + name +
                      " are missing: its data could not be opened again. `raymoval report` prints "
                      "the reason; name its folder with --data.") +
            "</p>\n";
  }
  if (!request.with_points) {
    return "<p>This report was made without the 3-D view.</p>\n";
  }
  if (points.scenes.empty()) {
    return html +
           "<p>No points to show: no removals were stored. Start the same command again with "
           "<code>--keep-removals</code>, then make the report again.</p>\n";
  }
  return html + view_html("view.html") +
         "<noscript><p>The 3-D view needs JavaScript.</p></noscript>\n";
}

std::vector<PageSection> sections_of(const PageRequest& request, const Points& points) {
  const ResultsRecord& record = request.run->record();
  const RunResults& results = request.run->results();
  std::vector<PageSection> sections = {
      {"methods", "Methods", methods_html(results)},
      {"points", "Points", points_html(request, points)},
      {"failures", "Failed cells", failures_html(results)},
      {"charts", "Charts", charts_html(results)},
      {"sequences", "Sequences", sequences_html(results)},
      {"losses", "Losses", losses_html(results)},
      {"confidence", "Confidence", confidence_html(results)},
      {"accuracy", "Accuracy", accuracy_html(results, request.published)},
      {"cells", "Cells", cells_html(results)},
      {"configuration", "Configuration", configuration_html(record, *request.methods)},
      {"cite", "Cite", citations_html(record.run, *request.methods)}};
  std::erase_if(sections, [](const PageSection& section) { return section.html.empty(); });
  return sections;
}

std::string navigation_html(const std::vector<PageSection>& sections) {
  std::string html = "<nav aria-label=\"Sections\"><div><ul>\n";
  for (const PageSection& section : sections) {
    html += "<li><a href=\"#" + section.id + "\">" + html_text(section.title) + "</a></li>\n";
  }
  return html + "</ul><button type=\"button\" id=\"theme\">Dark</button></div></nav>\n";
}

/// "a, b and c", or "4 methods".
std::string listed(const std::vector<std::string>& names, const std::string& noun) {
  constexpr std::size_t kMost = 3;
  if (names.size() > kMost) return std::to_string(names.size()) + " " + noun;
  if (names.size() < 2) return names.empty() ? "no " + noun : names.front();
  return join({names.begin(), names.end() - 1}) + " and " + names.back();
}

/// The title of a run: "simulated-quick: raymoval:online and raymoval:offline on town and
/// crossing". The name of a run without a suite file is left out.
std::string title_of(const RunResults& results) {
  std::vector<std::string> methods;
  for (const std::string& method : results.methods) {
    const SweptCell* point = results.swept(method);
    if (results.is_control(method)) continue;
    add_once(methods, point == nullptr ? method : "a sweep of " + point->sweep());
  }
  const std::string name = results.name == Suite().name ? "" : results.name + ": ";
  return name + (methods.empty() ? "the controls" : listed(methods, "methods")) + " on " +
         listed(results.sequences, "sequences");
}

/// Everything before <body>.
std::string head_html(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"generator\" content=\"raymoval " RAYMOVAL_VERSION
         "\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         html_text(title) + "</title>\n<style>\n" + chart_style() +
         std::string(page_file("page.css")) + "</style>\n</head>\n";
}

constexpr const char* kFooter =
    "<footer><p>Made by raymoval " RAYMOVAL_VERSION ". This file needs no network.</p></footer>\n";

/// The scripts of a page, and their data.
/// @param view the script of the view, see `page_file`
/// @param scenes the heads of `PackedScene`s; none: there is no view
/// @param streams those of all scenes
std::string scripts_html(const char* view, const std::vector<std::string>& scenes,
                         const std::vector<std::pair<std::string, std::string>>& streams) {
  std::string html = "<script>\n" + std::string(page_file("page.js")) + "</script>\n";
  if (scenes.empty()) return html;
  for (const auto& [id, text] : streams) {
    html += "<script type=\"application/octet-stream\" id=\"" + id + "\">" + text + "</script>\n";
  }
  html += "<script type=\"application/json\" id=\"scenes\">" + page_data(scenes) + "</script>\n";
  for (const char* script : {"scene_data.js", "stage.js", view}) {
    html += "<script>\n" + std::string(page_file(script)) + "</script>\n";
  }
  return html;
}

}  // namespace

Page make_page(const PageRequest& request) {
  const RunResults& results = request.run->results();
  Points points;
  if (request.with_points) points = collect_points(request);
  const std::vector<PageSection> sections = sections_of(request, points);
  const std::string title = title_of(results);
  std::string html = head_html(title) +
                     "<body>\n<a class=\"skip\" href=\"#main\">To the content</a>\n<header><h1>" +
                     html_name(title) + "</h1>\n" + facts_html(request.run->record(), results) +
                     "</header>\n" + navigation_html(sections) + "<main id=\"main\">\n";
  for (const PageSection& section : sections) html += html_section(section);
  html += "</main>\n" + std::string(kFooter) +
          scripts_html("report.js", points.scenes, points.streams) + "</body>\n</html>\n";
  return {std::move(html), std::move(points.warnings)};
}

std::string map_page(const Scene& scene, const std::string& title,
                     const std::vector<std::string>& lines) {
  const PackedScene packed = pack_scene(scene, 0);
  return head_html(title) +
         "<body>\n<a class=\"skip\" href=\"#main\">To the content</a>\n<header><h1>" +
         html_name(title) + "</h1>\n<button type=\"button\" id=\"theme\">Dark</button></header>\n" +
         "<main id=\"main\">\n" + view_html("review.html") +
         html_section({"facts", "What was done", html_list(lines)}) + "</main>\n" + kFooter +
         scripts_html("review.js", {packed.head}, packed.streams) + "</body>\n</html>\n";
}

}  // namespace raymoval
