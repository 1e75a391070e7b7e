// SPDX-License-Identifier: MIT
#include "methods/raymoval/raymoval.h"

namespace raymoval {
namespace {

std::vector<MethodVariant> raymoval_variants() {
  return {
      {"offline", "Every scan tested against the prior map that all scans leave.", false, {}},
      {"online",
       "Each scan answered when it arrives, from a growing map.",
       true,
       {{"offline", false}}},
      {"table1",
       "As offline, with every value as printed in Table 1.",
       false,
       {{"erase_tau1", 0.35}, {"erase_percentile", 0.9}}},
      {"table1-online",
       "As online, with every value as printed in Table 1.",
       true,
       {{"offline", false}, {"erase_tau1", 0.35}, {"erase_percentile", 0.9}}},
  };
}

}  // namespace

MethodEntry raymoval_entry() {
  MethodEntry entry;
  entry.name = "raymoval";
  entry.sentence =
      "Raycasting against the map: flags what stands in front of it, erases what is "
      "seen through, validates clusters against what remains.";
  entry.source = "Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping";
  entry.bibtex = R"(@misc{raymoval2025,
  title = {Raymoval: Raycasting-based Dynamic Object Removal for Static 3D Mapping},
  year = {2025},
  eprint = {2605.08937},
  archiveprefix = {arXiv},
  note = {RiTA 2025}
}
)";
  entry.version = "3";
  entry.notes = {
      "The paper leaves the erase test's margin, the origin of its map, and all cluster and "
      "coverage values open; table1 uses every printed value in both tests.",
      "The percentile is always one of the window's values (nearest rank).",
      "m(r) falls with the square of the range and d(r) is constant: the paper gives no form.",
  };
  entry.variants = raymoval_variants();
  entry.bind(raymoval_method::parameter_table(), raymoval_method::make_raymoval);
  return entry;
}

}  // namespace raymoval
