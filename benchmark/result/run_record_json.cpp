// SPDX-License-Identifier: MIT
#include "benchmark/result/run_record_json.h"

#include "benchmark/result/result_fields.h"

namespace raymoval {

using nlohmann::ordered_json;

std::vector<CellName> RunRecord::all_cells() const {
  std::vector<CellName> names;
  for (const SequenceRecord& sequence : sequences) {
    for (const SuiteMethodRecord& method : methods) {
      names.push_back({name_of(sequence), name_of(method)});
    }
  }
  return names;
}

const Cell* ResultsRecord::find(const CellName& name) const {
  for (const Cell& cell : cells) {
    if (cell.sequence == name.sequence && cell.name == name.name) return &cell;
  }
  return nullptr;
}

void describe_places(RecordWriter& writer, const std::vector<SequenceRecord>& sequences) {
  std::vector<std::optional<SequenceRequest>> places;
  for (const SequenceRecord& sequence : sequences) places.push_back(sequence.place);
  writer.optional("places", places);
}

void describe_places(RecordReader& reader, std::vector<SequenceRecord>& sequences) {
  std::vector<std::optional<SequenceRequest>> places;
  reader.optional("places", places);
  if (places.empty()) return;
  if (places.size() != sequences.size()) reader.fail("places", "is not one for each sequence");
  for (std::size_t i = 0; i < places.size(); ++i) sequences[i].place = places[i];
}

RunRecord read_run_record(const std::filesystem::path& file) {
  return read_sealed_with(file, read_as<RunRecord>);
}

void write_run_record(const std::filesystem::path& file, const RunRecord& run) {
  write_sealed(file, to_json(run));
}

ResultsRecord read_results(const std::filesystem::path& file) {
  return read_sealed_with(file, read_as<ResultsRecord>);
}

void write_results(const std::filesystem::path& file, const ResultsRecord& results) {
  write_sealed(file, to_json(results));
}

std::string read_results_text(const std::filesystem::path& file) {
  (void)read_results(file);
  return json_text(read_sealed(file));
}

}  // namespace raymoval
