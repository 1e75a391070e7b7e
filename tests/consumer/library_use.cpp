// SPDX-License-Identifier: MIT
// The libraries without the harness: a program runs a method of its own on the built-in scene and
// scores the answer.
#include <cstdio>

#include "core/scan/mask_store.h"
#include "datasets/open_sequence.h"
#include "eval/protocol_registry.h"
#include "methods/registry.h"

using namespace raymoval;

/// Removes points nearer to the sensor than a limit.
class NearRemover : public Remover {
 public:
  explicit NearRemover(double limit) : limit_(limit) {}
  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    for (std::size_t i = 0; i < scans.size(); ++i) {
      context.check_cancelled();
      const Scan scan = scans.load(i);
      Mask mask(scan.size());
      for (std::size_t k = 0; k < scan.size(); ++k) mask[k] = scan.points[k].norm() < limit_;
      sink.accept(i, mask);
    }
  }

 private:
  double limit_;
};

struct StoreSink : RemovalSink {
  explicit StoreSink(std::size_t scans) : masks(scans) {}
  void accept(std::size_t scan, const Mask& mask) override { masks.set(scan, mask); }
  MaskStore masks;
};

int main() {
  MethodEntry entry;
  entry.name = "near";
  entry.parameters = {{"limit", 10.0, {.unit = "m", .minimum = 0.0}, {}}};
  entry.variants = {{.name = "default", .sentence = "Removes what is near.", .online = true}};
  entry.make = [](const Configuration& values) {
    return std::make_unique<NearRemover>(std::get<double>(values.front().second));
  };
  MethodRegistry registry;
  registry.add(entry);

  const Sequence street = open_sequence("street", {.frames = parse_frame_range("0:4")});
  StoreSink sink(street.scans->size());
  registry.configure("near").make()->run(*street.scans, sink, {});

  EvaluationInput input;
  input.scans = street.scans.get();
  input.labels = street.labels.get();
  const auto protocol = make_protocol("erasor", protocol_defaults("erasor"));
  const ProtocolResult result = protocol->open(input)->score(sink.masks);
  const auto rate = result.rate("PR");
  std::printf("removed %zu points, PR %.3f\n", sink.masks.removed_count(), rate.value_or(-1.0));
  return sink.masks.removed_count() > 0 && rate && *rate > 0.0 && *rate < 100.0 ? 0 : 1;
}
