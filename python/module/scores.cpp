// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "benchmark/run/scored_sequence.h"
#include "core/parallel.h"
#include "eval/protocol_registry.h"
#include "python/module/bindings.h"
#include "python/module/interruptible.h"
#include "python/module/masks.h"
#include "python/module/optional_number.h"

namespace raymoval::python {
namespace {

/// Keyword arguments of raymoval.ProtocolScore.
py::dict dict_of(const ProtocolResult& result) {
  py::dict counts, rates, undefined, intervals, scored;
  for (const auto& [name, count] : result.counts) counts[py::str(name)] = count;
  for (const Rate& rate : result.rates) {
    rates[py::str(rate.name)] = optional_number(rate.value);
    if (!rate.value) undefined[py::str(rate.name)] = rate.undefined_reason;
  }
  if (result.intervals) {
    for (const Interval& interval : result.intervals->rates) {
      if (!interval.low || !interval.high) continue;
      intervals[py::str(interval.name)] = py::make_tuple(*interval.low, *interval.high);
    }
  }
  scored["protocol"] = result.protocol;
  scored["counts"] = counts;
  scored["rates"] = rates;
  scored["undefined"] = undefined;
  scored["intervals"] = intervals;
  scored["warnings"] = py::cast(result.warnings);
  return scored;
}

py::dict dict_of(const std::vector<ColumnValue>& columns) {
  py::dict values;
  for (const ColumnValue& column : columns) {
    values[py::str(column.name)] = py::make_tuple(optional_number(column.share.percent()),
                                                  column.share.part, column.share.whole);
  }
  return values;
}

/// @param settings options of protocols as texts "NAME.key=value"
std::vector<ProtocolRequest> requests_of(const std::vector<std::string>& protocols,
                                         const std::vector<std::string>& settings) {
  Suite suite;
  for (const std::string& protocol : protocols) add_protocol(suite, protocol, "");
  if (suite.protocols.empty()) add_protocol(suite, default_protocol(), "");
  for (const std::string& text : settings) {
    set_protocol_option(suite.protocols, parse_setting(text));
  }
  return suite.protocols;
}

py::dict score(const HeldSequence& held, const py::object& given,
               const std::vector<std::string>& protocols, const std::vector<std::string>& settings,
               int threads, const py::object& on_progress) {
  const std::vector<ProtocolRequest> requests = requests_of(protocols, settings);
  const MaskStore masks = masks_from(given, held);
  SequenceScores scores;
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    ScoredSequence scored(*held.sequence, requests, threads > 0 ? threads : hardware_threads(),
                          work.progress);
    scores = scored.score(masks, work.cancel);
    work.progress->end();
  });
  py::list scored;
  for (const ProtocolResult& result : scores.protocols) scored.append(dict_of(result));
  py::dict answer;
  answer["protocols"] = scored;
  answer["columns"] = dict_of(scores.columns);
  return answer;
}

}  // namespace

void bind_scores(py::module_& module) {
  module.def("score", &score, py::arg("sequence"), py::arg("masks"), py::arg("protocols"),
             py::arg("settings"), py::arg("threads"), py::arg("on_progress"));
}

}  // namespace raymoval::python
