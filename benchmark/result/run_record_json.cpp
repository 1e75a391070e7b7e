// SPDX-License-Identifier: MIT
#include "benchmark/result/run_record_json.h"

#include "benchmark/result/cell_fields.h"

namespace raymoval {

using nlohmann::ordered_json;

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<SequenceRecord> sequence) {
  describe(visitor, sequence.data);
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

/// Where the sequences were found, a list beside theirs.
void describe_places(RecordWriter& writer, const std::vector<SequenceRecord>& sequences) {
  std::vector<std::optional<SequenceRequest>> places;
  for (const SequenceRecord& sequence : sequences) places.push_back(sequence.place);
  writer.optional("places", places);
}

void describe_places(RecordReader& reader, std::vector<SequenceRecord>& sequences) {
  std::vector<std::optional<SequenceRequest>> places;
  reader.optional("places", places);
  if (places.empty()) return;  // Of an earlier version.
  if (places.size() != sequences.size()) reader.fail("places", "is not one for each sequence");
  for (std::size_t i = 0; i < places.size(); ++i) sequences[i].place = places[i];
}

/// @param is_whole whether it is run.json, and not a part of results.json, which has no paths and
/// has the cells themselves
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
  if (is_whole) visitor.later_field("cells", run.cells);
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

ordered_json to_json(const RunRecord& run) {
  return written(run);
}

RunRecord run_record_from(const ordered_json& json, const std::string& file) {
  auto run = read_as<RunRecord>(json, file);
  // Earlier versions did not list the cells: there each sequence goes with each method.
  if (!json.contains("cells")) run.cells = run.all_cells();
  return run;
}

RunRecord read_run_record(const std::filesystem::path& file) {
  return read_sealed_with(file, run_record_from);
}

void write_run_record(const std::filesystem::path& file, const RunRecord& run) {
  write_sealed(file, written(run));
}

ordered_json to_json(const ResultsRecord& results) {
  return written(results);
}

ResultsRecord results_from(const ordered_json& json, const std::string& file) {
  return read_as<ResultsRecord>(json, file);
}

ResultsRecord read_results(const std::filesystem::path& file) {
  return read_sealed_with(file, results_from);
}

void write_results(const std::filesystem::path& file, const ResultsRecord& results) {
  write_sealed(file, written(results));
}

std::string read_results_text(const std::filesystem::path& file) {
  (void)read_results(file);
  return json_text(read_sealed(file));
}

}  // namespace raymoval
