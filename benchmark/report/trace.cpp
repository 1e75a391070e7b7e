// SPDX-License-Identifier: MIT
// Where a report's numbers come from: failures, changes, configuration.
#include <nlohmann/json.hpp>

#include "benchmark/report/sections.h"
#include "core/text.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

std::string plain_text(const ordered_json& value) {
  if (value.is_null()) return "none";
  return value.is_string() ? value.get<std::string>()
                           : value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

/// The parameter's table entry, if this program knows the method.
const ParameterSpec* spec_of(const MethodRegistry& methods, const std::string& method,
                             const std::string& key) {
  for (const auto& entry : methods.entries()) {
    if (entry->name != method) continue;
    for (const ParameterSpec& spec : entry->parameters) {
      if (spec.name == key) return &spec;
    }
  }
  return nullptr;
}

TextTable parameter_table(const ordered_json& method, const MethodRegistry& methods) {
  const auto full = method.at("method").get<std::string>();
  TextTable table{"Parameters of " + method.at("name").get<std::string>(),
                  "parameter",
                  {{"", {"value", "default", "unit", "meaning"}}},
                  {},
                  {}};
  for (const auto& [key, value] : method.at("parameters").items()) {
    const ParameterSpec* spec = spec_of(methods, full.substr(0, full.find(':')), key);
    TableRow row{key, {{plain_text(value)}, {}, {}, {}}, false};
    if (spec != nullptr) {
      row.cells[1].text = parameter_text(spec->default_value);
      row.cells[2].text = spec->notes.unit;
      row.cells[3].text = spec->notes.sentence;
      if (row.cells[0].text != row.cells[1].text) row.cells[0].mark = Mark::kBest;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string methods_part(const ordered_json& json, const MethodRegistry& methods) {
  std::string html =
      "<h3>Methods</h3>\n<p class=\"note\">Every parameter as it was used; bold where "
      "it is not the method's default.</p>\n";
  for (const ordered_json& method : json.at("run").at("suite").at("methods")) {
    const auto name = method.at("name").get<std::string>();
    const auto full = method.at("method").get<std::string>();
    html += "<details><summary>" + html_text(name) + "</summary>\n<p>" + html_text(full) +
            ", version " + html_text(method.at("version").get<std::string>()) + "</p>\n";
    if (!method.at("parameters").empty()) html += html_table(parameter_table(method, methods));
    html += "</details>\n";
  }
  return html;
}

std::string range_text(const ordered_json& range) {
  if (!range.is_object()) return "";
  const ordered_json& max = range.at("max");
  return plain_text(range.at("min")) + " m to " + (max.is_null() ? "any" : plain_text(max) + " m");
}

std::string sequences_part(const ordered_json& json) {
  TextTable table{"Sequences",
                  "sequence",
                  {{"",
                    {"layout", "frames", "scans", "poses", "sensor", "range", "label rule",
                     "origin", "fingerprint"}}},
                  {},
                  {}};
  for (const ordered_json& sequence : json.at("run").at("suite").at("sequences")) {
    const auto name = sequence.at("name").get<std::string>();
    std::string fingerprint = "not read";
    for (const ordered_json& cell : json.at("cells")) {
      if (cell.at("sequence") != name || cell.at("data").is_null()) continue;
      fingerprint = cell.at("data").at("fingerprint").get<std::string>();
    }
    const ordered_json& rule = sequence.at("label_rule");
    TableRow row{name, {}, false};
    for (const char* key : {"layout", "frames", "scans", "poses", "sensor"}) {
      row.cells.push_back({plain_text(sequence.at(key))});
    }
    row.cells.push_back({range_text(sequence.at("range_m"))});
    row.cells.push_back({rule.is_null() ? "none" : plain_text(rule.at("name"))});
    row.cells.push_back({plain_text(sequence.at("source"))});
    row.cells.push_back({fingerprint});
    table.rows.push_back(std::move(row));
  }
  return html_table(table);
}

std::string protocols_part(const ordered_json& json) {
  TextTable table{"Protocols", "protocol", {{"", {"kind", "options"}}}, {}, {}};
  for (const ordered_json& protocol : json.at("run").at("suite").at("protocols")) {
    std::string options;
    for (const auto& [key, value] : protocol.at("options").items()) {
      options += (options.empty() ? "" : ", ") + key + " " + plain_text(value);
    }
    table.rows.push_back({protocol.at("name").get<std::string>(),
                          {{protocol.at("protocol").get<std::string>()}, {options}},
                          false});
  }
  return html_table(table);
}

std::string machine_part(const ordered_json& json) {
  TextTable table{"Program and machine", "what", {{"", {"value"}}}, {}, {}};
  for (const char* part : {"build", "machine"}) {
    if (!json.at("run").contains(part) || json.at("run").at(part).is_null()) continue;
    for (const auto& [key, value] : json.at("run").at(part).items()) {
      std::string name = key;
      for (char& c : name) c = c == '_' ? ' ' : c;
      table.rows.push_back({name, {{plain_text(value)}}, false});
    }
  }
  return table.rows.empty() ? "" : html_table(table);
}

TextTable key_table(const ordered_json& json) {
  TextTable table{"Keys of the cells", "sequence", {{"", {"method", "key"}}}, {}, {}};
  for (const ordered_json& cell : json.at("cells")) {
    table.rows.push_back({cell.at("sequence").get<std::string>(),
                          {{cell.at("name").get<std::string>()}, {plain_text(cell.at("key"))}},
                          false});
  }
  table.notes.push_back(
      "The key is a hash of method, version, parameters, data and protocols: two cells with the "
      "same "
      "key have the same counts.");
  return table;
}

}  // namespace

std::string failures_html(const ReportContent& content) {
  std::string html;
  for (const ordered_json& cell : content.json->at("cells")) {
    const auto status = cell.at("status").get<std::string>();
    if (status == "ok") continue;
    const auto tail = cell.at("output_tail").get<std::string>();
    html += "<div class=\"failure\"><h3>" +
            html_text(cell.at("sequence").get<std::string>() + " / " +
                      cell.at("name").get<std::string>()) +
            " <span class=\"badge bad\">" + html_text(status) + "</span></h3>\n<p>" +
            html_text(cell.at("reason").get<std::string>()) + "</p>\n";
    if (!tail.empty()) {
      html += "<details open><summary>The end of what it printed</summary><pre>" + html_text(tail) +
              "</pre></details>\n";
    }
    html += "</div>\n";
  }
  if (!content.results->missing.empty()) {
    html += "<h3>Not run</h3>\n" + html_list(content.results->missing);
  }
  return html;
}

std::string comparison_html(const Comparison& comparison, const std::string& name) {
  std::string html = "<p>Compared with " + html_text(name) + ": " +
                     std::to_string(comparison.same_cells) + " of " +
                     std::to_string(comparison.cells) + " cells are the same. ";
  switch (comparison.verdict()) {
    case ExitCode::kCannotDo:
      html += "<strong class=\"bad\">Not comparable.</strong></p>\n";
      break;
    case ExitCode::kWorse:
      html += "<strong class=\"bad\">Worse.</strong></p>\n";
      break;
    default:
      html += std::string("<strong class=\"good\">") +
              (comparison.better.empty() ? "No regression." : "Better, no regression.") +
              "</strong></p>\n";
  }
  const std::pair<const char*, const std::vector<std::string>*> parts[] = {
      {"Not comparable", &comparison.incomparable},
      {"Worse", &comparison.worse},
      {"Better", &comparison.better},
      {"Moved or new", &comparison.moved},
      {"Time", &comparison.times}};
  for (const auto& [heading, lines] : parts) {
    if (!lines->empty()) html += std::string("<h3>") + heading + "</h3>\n" + html_list(*lines);
  }
  return html;
}

std::string configuration_html(const ReportContent& content, const MethodRegistry& methods) {
  const ordered_json& json = *content.json;
  return methods_part(json, methods) + "<h3>Data and measure</h3>\n" + sequences_part(json) +
         protocols_part(json) + machine_part(json) +
         "<details><summary>Keys of the cells</summary>\n" +
         html_table(key_table(json), TableHeight::kScrolled) + "</details>\n";
}

}  // namespace raymoval
