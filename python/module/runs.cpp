// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/results.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/runner.h"
#include "benchmark/tables/run_summary.h"
#include "eval/protocol_registry.h"
#include "python/module/bindings.h"
#include "python/module/interruptible.h"
#include "python/module/optional_number.h"
#include "python/module/remover.h"
#include "python/module/sequences.h"

namespace raymoval::python {
namespace {

/// The arguments of `raymoval.run`.
struct RunRequest {
  std::vector<py::object> sequences;  ///< Sequences that were opened.
  py::list methods;                   ///< Names, and dicts for `python_entry`.
  std::vector<std::string> protocols;
  std::vector<std::string> settings;  ///< "METHOD.key=value".
  bool controls = true;
  int threads = 0;
};

void add_methods(const RunRequest& request, MethodRegistry& registry, Suite& suite) {
  std::vector<std::string> names;
  for (const py::handle method : request.methods) {
    if (py::isinstance<py::dict>(method)) {
      MethodEntry entry = python_entry(method.cast<py::dict>());
      names.push_back(entry.name + ":" + entry.variants.front().name);
      registry.add(std::move(entry));
    } else {
      for (const std::string& name : expanded_methods(method.cast<std::string>(), registry)) {
        names.push_back(name);
      }
    }
  }
  for (const std::string& name : names) add_method(suite, name, "", registry);
}

Suite suite_of(const RunRequest& request, MethodRegistry& registry) {
  Suite suite;
  for (const py::object& one : request.sequences) {
    const HeldSequence& held = one.cast<const HeldSequence&>();
    if (!held.place) {
      throw UsageError("sequence '" + held.sequence->name +
                       "' is made of arrays, which a run cannot open again. Write its scans into "
                       "a folder, or use raymoval.clean and raymoval.score.");
    }
    suite.sequences.push_back(*held.place);
  }
  add_methods(request, registry, suite);
  for (const std::string& protocol : request.protocols) add_protocol(suite, protocol, "");
  if (suite.protocols.empty()) add_protocol(suite, default_protocol(), "");
  std::vector<Setting> settings;
  for (const std::string& text : request.settings) settings.push_back(parse_setting(text));
  apply_settings(suite, settings);
  if (request.controls) add_controls(suite, registry);
  suite.controls = request.controls;
  suite.threads = request.threads;
  return suite;
}

py::dict dict_of(const RunSummary& summary, const std::vector<std::string>& without_effect) {
  py::dict answer;
  answer["cells"] = summary.cells;
  answer["reused"] = summary.reused;
  answer["failures"] = py::cast(summary.failures);
  answer["control_problems"] = py::cast(summary.controls);
  std::vector<std::string> warnings = without_effect;
  warnings.insert(warnings.end(), summary.lost_scans.begin(), summary.lost_scans.end());
  answer["warnings"] = py::cast(warnings);
  return answer;
}

py::dict run(const std::vector<py::object>& sequences, const py::list& methods,
             const std::vector<std::string>& protocols, const std::vector<std::string>& settings,
             const std::string& out, bool controls, bool keep_removals, bool overwrite, int threads,
             const py::object& on_progress) {
  const RunRequest request{sequences, methods, protocols, settings, controls, threads};
  MethodRegistry registry = MethodRegistry::built_in();
  const Suite suite = suite_of(request, registry);
  RunSummary summary;
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    RunOptions options;
    options.out = out;
    options.keep_removals = keep_removals;
    options.overwrite = overwrite;
    options.progress = work.progress;
    options.cancel = work.cancel;
    summary = run_suite(suite, options);
    work.progress->end();
  });
  return dict_of(summary, settings_without_effect(suite));
}

/// A row of results.csv.
py::dict dict_of(const Cell& cell, const std::string& protocol,
                 const std::vector<std::string>& rates) {
  const Score score = cell.score(protocol) != nullptr ? *cell.score(protocol) : Score{};
  const Measurement measured = cell.measured.value_or(Measurement{});
  py::dict record;
  record["sequence"] = cell.sequence;
  record["method"] = cell.method.name;
  record["variant"] = cell.method.variant;
  record["cell"] = cell.name;
  record["protocol"] = protocol;
  record["status"] = status_name(cell.status);
  record["control"] = cell.method.control;
  for (const std::string& rate : rates) record[py::str(rate)] = optional_number(score.rate(rate));
  for (const Interval& ends : score.intervals ? score.intervals->rates : std::vector<Interval>{}) {
    if (!ends.low) continue;
    record[py::str(ends.name + "_low")] = *ends.low;
    record[py::str(ends.name + "_high")] = *ends.high;
  }
  record["seconds_per_scan"] =
      optional_number(cell.measured ? std::optional(measured.mean_seconds) : std::nullopt);
  record["peak_memory_mib"] = optional_number(measured.peak_memory_mib);
  return record;
}

py::list load_run(const std::string& folder) {
  const RunResults results = shown_results(read_results(find_results(folder)));
  std::vector<std::string> rates;
  for (const std::string& protocol : results.protocols) {
    for (const std::string& rate : results.rates_of(protocol)) {
      if (std::find(rates.begin(), rates.end(), rate) == rates.end()) rates.push_back(rate);
    }
  }
  py::list rows;
  for (const Cell& cell : results.cells) {
    for (const std::string& protocol : results.protocols) {
      rows.append(dict_of(cell, protocol, rates));
    }
  }
  return rows;
}

std::string summary_text(const std::string& folder) {
  return run_summary(shown_results(read_results(find_results(folder))), folder);
}

ComparisonOptions comparison_options(const std::map<std::string, double>& tolerances,
                                     const std::vector<std::string>& across,
                                     const std::optional<double>& time_band) {
  ComparisonOptions options;
  options.tolerances = tolerances;
  options.time_band = time_band;
  for (const std::string& what : across) {
    if (what == "parameters") {
      options.across_parameters = true;
    } else if (what == "version") {
      options.across_version = true;
    } else {
      throw UsageError("across: '" + what + "', expected 'parameters' or 'version'.");
    }
  }
  return options;
}

py::dict compare(const std::string& run, const std::string& reference,
                 const std::map<std::string, double>& tolerances,
                 const std::vector<std::string>& across, const std::optional<double>& time_band) {
  const Comparison comparison =
      compare_results(read_result_set(find_results(run)), read_result_set(find_results(reference)),
                      comparison_options(tolerances, across, time_band));
  py::dict answer;
  answer["verdict"] = comparison.verdict_words();
  answer["exit_code"] = static_cast<int>(comparison.verdict());
  answer["worse"] = py::cast(comparison.worse);
  answer["better"] = py::cast(comparison.better);
  answer["moved"] = py::cast(comparison.moved);
  answer["incomparable"] = py::cast(comparison.incomparable);
  answer["times"] = py::cast(comparison.times);
  answer["cells"] = comparison.cells;
  answer["same_cells"] = comparison.same_cells;
  answer["text"] = comparison_text(comparison);
  return answer;
}

}  // namespace

void bind_runs(py::module_& module) {
  module.def("run", &run, py::arg("sequences"), py::arg("methods"), py::arg("protocols"),
             py::arg("settings"), py::arg("out"), py::arg("controls"), py::arg("keep_removals"),
             py::arg("overwrite"), py::arg("threads"), py::arg("on_progress"));
  module.def("load_run", &load_run, py::arg("folder"));
  module.def("summary_text", &summary_text, py::arg("folder"));
  module.def("compare", &compare, py::arg("run"), py::arg("reference"), py::arg("tolerances"),
             py::arg("across"), py::arg("time_band"));
}

}  // namespace raymoval::python
