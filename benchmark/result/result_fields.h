// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/result/record_fields.h"
#include "benchmark/result/run_record.h"

namespace raymoval {

// The fields of cell.json, run.json, results.json and of their parts, in the order of the files.
// `to_json` and `read_as` of record_fields.h make JSON of a record that is described here, and read
// it again. Keys, their order and the texts of numbers are fixed: a record that is read and written
// again has the same bytes.

void describe_rates(RecordWriter& writer, const std::vector<Rate>& rates);
void describe_rates(RecordReader& reader, std::vector<Rate>& rates);
void describe_rates(RecordWriter& writer, const std::vector<Interval>& rates);
void describe_rates(RecordReader& reader, std::vector<Interval>& rates);
void describe(RecordWriter& writer, const ColumnRecord& columns);
void describe(RecordReader& reader, ColumnRecord& columns);
void describe(RecordWriter& writer, const Reliability& reliability);
void describe(RecordReader& reader, Reliability& reliability);

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<ReliabilityBin> bin) {
  visitor.field("points", bin.points);
  visitor.field("moving", bin.moving);
  visitor.field("steps", bin.steps);
}

/// A column without its name, which is its key.
template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<ColumnValue> column) {
  visitor.field("part", column.share.part);
  visitor.field("whole", column.share.whole);
  std::optional<double> percent = column.share.percent();
  visitor.require("percent");
  visitor.nullable("percent", percent);
  if (!percent) visitor.field("undefined", column.undefined_reason);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<EgoRecord> ego) {
  visitor.field("asked", ego.asked);
  visitor.field("left_out", ego.left_out);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<LabelRule> rule) {
  visitor.field("name", rule.name);
  visitor.field("moving", rule.moving);
  visitor.field("ignored", rule.ignored);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<RangeLimits> range) {
  visitor.field("min", range.min);
  visitor.limit("max", range.max, RangeLimits{}.max);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<DataRecord> data) {
  visitor.name("name", data.name);
  visitor.field("layout", data.layout);
  visitor.field("source", data.source);
  visitor.field("frames", data.frames);
  visitor.field("scans", data.scans);
  visitor.field("poses", data.poses);
  visitor.field("sensor", data.sensor);
  visitor.optional("sensor_basis", data.sensor_basis);
  visitor.optional("up", data.up);
  visitor.optional("up_source", data.up_source);
  visitor.nullable("scan_period_s", data.scan_period_s);
  visitor.field("range_m", data.range_m);
  visitor.optional("drop_ego", data.drop_ego);
  visitor.nullable("label_rule", data.label_rule);
  visitor.optional("T_sensor", data.T_sensor);
  visitor.optional("sensor_origin", data.sensor_origin);
  visitor.optional("time_offset_s", data.time_offset_s);
  visitor.optional("deskew", data.deskew);
  visitor.optional("losses", data.losses);
  visitor.optional("fingerprint", data.fingerprint);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<PoseFitRecord> fit) {
  visitor.field("median_m", fit.median_m);
  visitor.field("worst_m", fit.worst_m);
  visitor.field("pairs", fit.pairs);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<MethodRecord> method) {
  visitor.name("name", method.name);
  visitor.name("variant", method.variant);
  visitor.field("version", method.version);
  visitor.field("online", method.online);
  visitor.field("control", method.control);
  visitor.field("parameters", method.parameters);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<ProtocolRecord> protocol) {
  visitor.name("name", protocol.name);
  visitor.name("protocol", protocol.protocol);
  visitor.optional("version", protocol.version);
  visitor.field("options", protocol.options);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<CellIdentity> identity) {
  visitor.schema_version();
  visitor.field("method", identity.method);
  visitor.field("data", identity.data);
  visitor.nested("columns",
                 [](auto& columns) { columns.field("version", std::string(kColumnsVersion)); });
  visitor.optional("protocols", identity.protocols);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<Intervals> intervals) {
  visitor.field("level", intervals.options.level);
  visitor.field("replicates", intervals.options.replicates);
  visitor.field("seed", intervals.options.seed);
  visitor.field("block_scans", intervals.block_scans);
  describe_rates(visitor, intervals.rates);
}

/// The common fields of a Score and a ProtocolResult.
template <class Visitor, class Result>
void describe_result(Visitor& visitor, Result& result) {
  visitor.field("counts", result.counts);
  describe_rates(visitor, result.rates);
  visitor.field("warnings", result.warnings);
  visitor.optional("intervals", result.intervals);
  visitor.optional("by_scan", result.by_scan);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<ProtocolResult> result) {
  describe_result(visitor, result);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<Score> score) {
  visitor.require("version");
  describe(visitor, score.protocol);
  describe_result(visitor, score);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<MaskRecord> masks) {
  visitor.field("digest", masks.digest);
  visitor.field("removed", masks.removed);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<StageSeconds> stage) {
  visitor.field("name", stage.name);
  visitor.field("seconds", stage.seconds);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<Measurement> measured) {
  visitor.field("threads", measured.threads);
  visitor.nested("seconds_per_scan", [&](auto& by_scan) {
    by_scan.field("mean", measured.mean_seconds);
    by_scan.nullable("median", measured.median_seconds);
    by_scan.nullable("p90", measured.p90_seconds);
  });
  visitor.field("seconds_total", measured.total_seconds);
  visitor.field("seconds_load", measured.load_seconds);
  visitor.field("stages", measured.stages);
  visitor.nullable("peak_memory_mib", measured.peak_memory_mib);
  visitor.optional("side_by_side", measured.side_by_side);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<Cell> cell) {
  visitor.schema_version();
  visitor.name("sequence", cell.sequence);
  visitor.name("name", cell.name);
  visitor.nullable("key", cell.key);
  visitor.field("status", cell.status);
  visitor.field("reason", cell.reason);
  visitor.field("output_tail", cell.output_tail);
  visitor.field("method", cell.method);
  visitor.nullable("data", cell.data);
  visitor.field("protocols", cell.scores);
  visitor.nullable("columns", cell.columns);
  visitor.optional("confidence", cell.reliability);
  visitor.nullable("masks", cell.masks);
  visitor.nullable("measured", cell.measured);
}

// run.json and results.json.

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<SequenceRecord> sequence) {
  describe(visitor, sequence.data);
  visitor.optional("pose_fit", sequence.pose_fit);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<SweepRecord> sweep) {
  visitor.name("of", sweep.of);
  visitor.field("values", sweep.values);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<SuiteMethodRecord> method) {
  visitor.name("name", method.name);
  visitor.name("method", method.method);
  visitor.field("version", method.version);
  visitor.field("parameters", method.parameters);
  visitor.optional("sweep", method.sweep);
  visitor.optional("changed_from", method.changed_from);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<CellName> cell) {
  visitor.name("sequence", cell.sequence);
  visitor.name("name", cell.name);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<BuildRecord> build) {
  visitor.field("version", build.version);
  visitor.optional("commit", build.commit);
  visitor.optional("source_tree", build.source_tree);
  visitor.field("compiler", build.compiler);
  visitor.field("build_type", build.build_type);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<MachineRecord> machine) {
  visitor.field("processor", machine.processor);
  visitor.field("cores", machine.cores);
  visitor.nullable("memory_gib", machine.memory_gib);
  visitor.field("threads", machine.threads);
  visitor.optional("jobs", machine.jobs);
}

/// The places of the sequences, in a separate list.
void describe_places(RecordWriter& writer, const std::vector<SequenceRecord>& sequences);
void describe_places(RecordReader& reader, std::vector<SequenceRecord>& sequences);

/// @param is_whole true for run.json, false for the part of results.json, which has cells and no
/// paths
template <class Visitor>
void describe_run(Visitor& visitor, typename Visitor::template Of<RunRecord> run, bool is_whole) {
  visitor.schema_version();
  visitor.nested("suite", [&](auto& suite) {
    suite.name("name", run.suite);
    suite.field("sequences", run.sequences);
    suite.field("methods", run.methods);
    suite.field("protocols", run.protocols);
    suite.field("controls", run.controls);
  });
  if (is_whole) visitor.field("cells", run.cells);
  visitor.nullable("build", run.build);
  visitor.nullable("machine", run.machine);
  if (is_whole) describe_places(visitor, run.sequences);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<RunRecord> run) {
  describe_run(visitor, run, true);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<ResultsRecord> results) {
  visitor.schema_version();
  visitor.nested("run", [&](auto& part) { describe_run(part, results.run, false); });
  visitor.nested("controls", [&](auto& controls) {
    controls.field("checked", results.controls_checked);
    controls.field("problems", results.control_problems);
  });
  visitor.optional("missing", results.missing);
  visitor.field("cells", results.cells);
}

}  // namespace raymoval
