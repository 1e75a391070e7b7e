// SPDX-License-Identifier: MIT
// The origin of a report's numbers: failures, configuration.
#include "benchmark/report/sections.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/tables/citations.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// The parameter's table entry; null if the registry lacks the method.
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

TextTable parameter_table(const SuiteMethodRecord& method, const MethodRegistry& methods) {
  TextTable table{
      "Parameters of " + method.name, "parameter", {{"", {"value", "default", "unit", "meaning"}}}};
  const std::string without_variant = method.method.substr(0, method.method.find(':'));
  for (const auto& [key, value] : method.parameters) {
    const ParameterSpec* spec = spec_of(methods, without_variant, key);
    TableRow row{key, {{plain_text(value)}, {}, {}, {}}, false};
    if (spec != nullptr) {
      row.cells[1].text = parameter_text(spec->default_value);
      row.cells[2].text = spec->notes.unit;
      row.cells[3].text = spec->notes.sentence;
      if (value != spec->default_value) row.cells[0].mark = Mark::kBest;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string methods_part(const RunRecord& run, const MethodRegistry& methods) {
  std::string html =
      "<h3>Methods</h3>\n<p class=\"note\">Every parameter as it was used; bold where "
      "it is not the method's default.</p>\n";
  for (const SuiteMethodRecord& method : run.methods) {
    html += "<details><summary>" + html_text(method.name) + "</summary>\n<p>" +
            html_text(method.method) + ", version " + html_text(method.version) + "</p>\n";
    if (!method.parameters.empty()) html += html_table(parameter_table(method, methods));
    html += "</details>\n";
  }
  return html;
}

std::string range_text(const RangeLimits& range) {
  const bool unlimited = range.max >= RangeLimits{}.max;
  return plain_text(range.min) + " m to " + (unlimited ? "any" : plain_text(range.max) + " m");
}

/// The fingerprint of a sequence as its cells have it.
std::string fingerprint_text(const ResultsRecord& results, const std::string& sequence) {
  std::string fingerprint = "not read";
  for (const Cell& cell : results.cells) {
    if (cell.sequence == sequence && cell.data) fingerprint = cell.data->fingerprint;
  }
  return fingerprint;
}

std::string sequences_part(const ResultsRecord& results) {
  const std::vector<std::string> columns = {"layout",     "frames", "scans",
                                            "poses",      "sensor", "range",
                                            "label rule", "origin", "fingerprint"};
  TextTable table{"Sequences", "sequence", {{"", columns}}};
  for (const SequenceRecord& sequence : results.run.sequences) {
    const DataRecord& data = sequence.data;
    TableRow row{data.name, {}, false};
    for (const std::string& text :
         {data.layout, data.frames, std::to_string(data.scans), data.poses, data.sensor,
          range_text(data.range_m), data.label_rule ? data.label_rule->name : "none", data.source,
          fingerprint_text(results, data.name)}) {
      row.cells.push_back({text});
    }
    table.rows.push_back(std::move(row));
  }
  return html_table(table);
}

std::string protocols_part(const RunRecord& run) {
  TextTable table{"Protocols", "protocol", {{"", {"kind", "options"}}}};
  for (const ProtocolRecord& protocol : run.protocols) {
    std::vector<std::string> options;
    for (const auto& [key, value] : protocol.options) {
      options.push_back(key + " " + plain_text(value));
    }
    table.rows.push_back({protocol.name, {{protocol.protocol}, {join(options)}}, false});
  }
  return html_table(table);
}

std::string machine_part(const RunRecord& run) {
  TextTable table{"Program and machine", "what", {{"", {"value"}}}};
  const auto add = [&](const char* name, const std::string& value) {
    table.rows.push_back({name, {{value}}, false});
  };
  if (run.build) {
    add("version", run.build->version);
    if (!run.build->commit.empty()) add("commit", run.build->commit);
    if (!run.build->source_tree.empty()) add("source tree", run.build->source_tree);
    add("compiler", run.build->compiler);
    add("build type", run.build->build_type);
  }
  if (run.machine) {
    const auto& memory = run.machine->memory_gib;
    add("processor", run.machine->processor);
    add("cores", std::to_string(run.machine->cores));
    add("memory gib", memory ? std::to_string(*memory) : "none");
    add("threads", std::to_string(run.machine->threads));
  }
  return table.rows.empty() ? "" : html_table(table);
}

TextTable key_table(const ResultsRecord& results) {
  TextTable table{"Keys of the cells", "sequence", {{"", {"method", "key"}}}};
  for (const Cell& cell : results.cells) {
    const std::string key = cell.key.empty() ? "none" : cell.key;
    table.rows.push_back({cell.sequence, {{cell.name}, {key}}, false});
  }
  table.notes.push_back(
      "The key is a hash of method, version, parameters, data and protocols: two cells with the "
      "same "
      "key have the same counts.");
  return table;
}

}  // namespace

std::string failures_html(const RunResults& results) {
  std::string html;
  for (const Cell& cell : results.cells) {
    if (cell.ok()) continue;
    html += "<div class=\"failure\"><h3>" + html_text(cell.title()) +
            " <span class=\"badge bad\">" + status_name(cell.status) + "</span></h3>\n<p>" +
            html_text(cell.reason) + "</p>\n";
    if (!cell.output_tail.empty()) {
      html += "<details open><summary>Last lines of its output</summary><pre>" +
              html_text(cell.output_tail) + "</pre></details>\n";
    }
    html += "</div>\n";
  }
  if (!results.missing.empty()) {
    html += "<h3>Not run</h3>\n" + html_list(results.missing);
  }
  return html;
}

std::string configuration_html(const ResultsRecord& record, const MethodRegistry& methods) {
  return methods_part(record.run, methods) + "<h3>Data and protocols</h3>\n" +
         sequences_part(record) + protocols_part(record.run) + machine_part(record.run) +
         "<details><summary>Keys of the cells</summary>\n" +
         html_table(key_table(record), TableHeight::kScrolled) + "</details>\n";
}

std::string citations_html(const RunRecord& run, const MethodRegistry& methods) {
  Citations citations(methods);
  citations.add_run(run);
  return "<details><summary>BibTeX of the program, methods and protocols</summary>\n<p "
         "class=\"note\">A click selects all of it.</p>\n<pre class=\"copied\">" +
         html_text(citations.text()) + "</pre></details>\n";
}

}  // namespace raymoval
