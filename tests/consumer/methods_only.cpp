// SPDX-License-Identifier: MIT
// Runs every built-in method on an empty sequence: all their parts must be linked.
#include <cstdio>

#include "methods/registry.h"

using namespace raymoval;

struct NoScans : ScanSource {
  std::size_t size() const override { return 0; }
  Scan load(std::size_t) const override { return {}; }
  Pose pose(std::size_t) const override { return Pose::Identity(); }
  const SensorModel& sensor() const override { return model; }
  SensorModel model;
};

struct NoMasks : RemovalSink {
  void accept(std::size_t, const Mask&) override { ++masks; }
  int masks = 0;
};

int main() {
  NoMasks sink;
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    if (entry->needs_truth) continue;
    MethodRegistry::built_in().configure(entry->name).make()->run(NoScans{}, sink, {});
    std::printf("%s\n", entry->name.c_str());
  }
  return sink.masks;
}
