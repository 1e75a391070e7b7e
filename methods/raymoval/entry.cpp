// SPDX-License-Identifier: MIT
#include "methods/raymoval/raymoval.h"

namespace raymoval {
namespace {

/// The readings of the paper, each with our values where the paper prints none and with every
/// printed value in both tests.
std::vector<MethodVariant> variants() {
  const auto reading = [](const char* map_source) {
    return Configuration{{"map_source", std::string(map_source)}};
  };
  const auto printed = [](Configuration values) {
    values.emplace_back("erase_tau1", 0.35);
    values.emplace_back("erase_percentile", 0.9);
    return values;
  };
  Configuration online = {{"offline", false}};
  online.emplace_back("map_source", std::string("growing"));
  const Configuration eq11 = {{"erased_points", false}};
  return {
      {"offline", "Every scan tested against the prior map that all scans leave.", false, {}},
      {"online", "Each scan answered when it arrives, from a growing map.", true, online},
      {"offline-growing", "Every point answered from the final state of a growing map.", false,
       reading("growing")},
      {"offline-naive", "Every point answered by what the scans see through; eq. 11 has no effect.",
       false, reading("naive")},
      {"offline-eq11", "As offline, but eq. 11 alone decides what is a candidate.", false, eq11},
      {"table1", "As offline, with every value as printed in Table 1.", false, printed({})},
      {"table1-online", "As online, with every value as printed in Table 1.", true,
       printed(online)},
      {"table1-growing", "As offline-growing, with every value as printed in Table 1.", false,
       printed(reading("growing"))},
      {"table1-naive", "As offline-naive, with every value as printed in Table 1.", false,
       printed(reading("naive"))},
      {"table1-eq11", "As offline-eq11, with every value as printed in Table 1.", false,
       printed(eq11)},
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
  entry.version = "3";
  entry.notes = {
      "The paper leaves the erase test's margin, the origin of its map, and all cluster and "
      "coverage values open; the variants called table1 use every printed value in both tests.",
      "The percentile is always one of the window's values (nearest rank).",
      "m(r) falls with the square of the range and d(r) is constant: the paper gives no form.",
  };
  entry.variants = variants();
  entry.bind(raymoval_method::parameter_table(), raymoval_method::make_raymoval);
  return entry;
}

}  // namespace raymoval
