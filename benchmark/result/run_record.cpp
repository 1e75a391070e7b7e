// SPDX-License-Identifier: MIT
#include "benchmark/result/run_record.h"

namespace raymoval {

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

}  // namespace raymoval
