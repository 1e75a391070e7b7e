// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include "methods/remover.h"

namespace raymoval {

/// A whole method as a function: the steps of its paper from scans to masks.
template <class Parameters>
using RunFunction = void (*)(const Parameters&, const ScanSource&, RemovalSink&, const RunContext&);

/// A method that consists of its parameters and one function.
template <class Parameters>
class FunctionRemover : public Remover {
 public:
  FunctionRemover(Parameters parameters, RunFunction<Parameters> function)
      : parameters_(std::move(parameters)), function_(function) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    function_(parameters_, scans, sink, context);
  }

 private:
  Parameters parameters_;
  RunFunction<Parameters> function_;
};

template <class Parameters>
std::unique_ptr<Remover> remover_from(const Parameters& parameters, RunFunction<Parameters> run) {
  return std::make_unique<FunctionRemover<Parameters>>(parameters, run);
}

}  // namespace raymoval
