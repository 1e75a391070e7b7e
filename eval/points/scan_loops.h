// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "core/parallel.h"
#include "eval/protocol.h"

namespace raymoval {

/// Calls `body(i)` for each scan on the input's threads, and shows progress as `task`.
template <class Body>
void for_each_scan(const EvaluationInput& input, const std::string& task, Body&& body) {
  const std::size_t scans = input.scans->size();
  if (input.progress != nullptr) input.progress->begin(task, scans);
  parallel_for(input.threads, scans, 1, [&](std::size_t i) {
    body(i);
    if (input.progress != nullptr) input.progress->advance();
  });
  if (input.progress != nullptr) input.progress->end();
}

}  // namespace raymoval
