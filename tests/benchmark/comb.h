// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "methods/remover.h"

namespace raymoval::test {

/// Removes every `step`-th point of each scan, from the first one on, and keeps the others.
class Comb : public Remover {
 public:
  explicit Comb(std::size_t step) : step_(step) {}
  void run(const ScanSource& scans, RemovalSink& sink, const RunContext&) override {
    for (std::size_t i = 0; i < scans.size(); ++i) {
      Mask mask(scans.load(i).size(), 0);
      for (std::size_t k = 0; k < mask.size(); k += step_) mask[k] = 1;
      sink.accept(i, mask);
    }
  }

 private:
  std::size_t step_;
};

}  // namespace raymoval::test
