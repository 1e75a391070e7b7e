// SPDX-License-Identifier: MIT
#include "methods/controls/controls.h"

#include "methods/common/remover_from.h"
#include "methods/common/scan_passes.h"

namespace raymoval {
namespace {

using MaskOf = std::function<Mask(const Scan&)>;

void replay(const MaskOf& mask_of, const ScanSource& scans, RemovalSink& sink,
            const RunContext& context) {
  for_each_scan("masks", scans, context,
                [&](const Scan& scan) { sink.accept(scan.index, mask_of(scan)); });
}

MaskOf constant_mask(std::uint8_t value) {
  return [value](const Scan& scan) { return Mask(scan.size(), value); };
}

MethodEntry control(const char* name, const char* sentence) {
  MethodEntry entry;
  entry.name = name;
  entry.sentence = sentence;
  entry.source = "control of the scoring";
  entry.variants = {{.name = "default", .sentence = sentence, .online = true}};
  return entry;
}

}  // namespace

std::unique_ptr<Remover> make_replay(const std::function<Mask(const Scan&)>& mask_of) {
  return remover_from(mask_of, replay);
}

MethodEntry noop_entry() {
  MethodEntry entry = control("noop", "Removes nothing; must score PR 100 and RR 0.");
  entry.make = [](const Configuration&) { return make_replay(constant_mask(0)); };
  return entry;
}

MethodEntry remove_all_entry() {
  MethodEntry entry = control("remove-all", "Removes every point; must score PR 0 and RR 100.");
  entry.make = [](const Configuration&) { return make_replay(constant_mask(1)); };
  return entry;
}

MethodEntry oracle_entry() {
  MethodEntry entry =
      control("oracle", "Removes exactly the points labelled moving; must score RR 100.");
  entry.needs_truth = true;
  entry.make = [](const Configuration&) -> std::unique_ptr<Remover> {
    throw UsageError("'oracle' needs labels: use raymoval run on a sequence with labels.");
  };
  return entry;
}

}  // namespace raymoval
