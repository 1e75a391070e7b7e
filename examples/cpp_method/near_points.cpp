// SPDX-License-Identifier: MIT
// A method of one's own, in a program that has all commands of raymoval:
//   near_points run --sequence street --method near --method raymoval --out out/near
#include "benchmark/harness.h"
#include "methods/remover.h"

using namespace raymoval;

struct NearParameters {
  double limit = 10.0;
};

/// Removes what is nearer to the sensor than a limit.
class NearRemover : public Remover {
 public:
  explicit NearRemover(const NearParameters& parameters) : parameters_(parameters) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    context.begin_pass("near points", scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      context.check_cancelled();
      const Scan scan = scans.load(i);
      Mask removed(scan.size(), 0);
      for (std::size_t k = 0; k < scan.size(); ++k) {
        removed[k] = scan.points[k].norm() < parameters_.limit ? 1 : 0;
      }
      sink.accept(i, removed);
      context.advance();
    }
  }

 private:
  NearParameters parameters_;
};

std::unique_ptr<Remover> make_near(const NearParameters& parameters) {
  return std::make_unique<NearRemover>(parameters);
}

MethodEntry near_entry() {
  static const auto table = ParameterTable<NearParameters>().number(
      "limit", &NearParameters::limit,
      {.unit = "m", .minimum = 0.0, .maximum = 200.0, .sentence = "Nearer points are removed."});
  MethodEntry entry;
  entry.name = "near";
  entry.sentence = "Removes what is near the sensor.";
  entry.variants = {{.name = "default", .sentence = "Each scan by itself.", .online = true}};
  entry.bind(table, make_near);
  return entry;
}

int main(int argc, char** argv) {
  MethodRegistry methods = MethodRegistry::built_in();
  methods.add(near_entry());
  return run_command_line(argc, argv, methods);
}
