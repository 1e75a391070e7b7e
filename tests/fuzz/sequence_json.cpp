// SPDX-License-Identifier: MIT
#include "datasets/settings.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_sequence_json(std::string_view bytes) {
  const auto path = fuzz::input_file("sequence.json", bytes);
  fuzz::may_refuse([&] {
    const SequenceSettings settings = read_settings(path.parent_path(), {}, {});
    fuzz::require(settings.range_m.min < settings.range_m.max, "a range is empty");
    fuzz::require(!settings.name.empty(), "a sequence has no name");
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(sequence_json, try_sequence_json)
