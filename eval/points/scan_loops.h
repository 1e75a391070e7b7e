// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

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

/// Calls `read(i)` for each scan on the input's threads, and `take(part)` with what it returned, in
/// the order of the scans. A batch is read at a time, so that few raw scans are in memory.
template <class Part, class Read, class Take>
void in_scan_order(const EvaluationInput& input, const std::string& task, Read&& read,
                   Take&& take) {
  const std::size_t scans = input.scans->size();
  const auto batch = static_cast<std::size_t>(std::max(1, input.threads)) * 4;
  if (input.progress != nullptr) input.progress->begin(task, scans);
  for (std::size_t first = 0; first < scans; first += batch) {
    std::vector<Part> parts(std::min(batch, scans - first));
    parallel_for(input.threads, parts.size(), 1, [&](std::size_t i) {
      parts[i] = read(first + i);
      if (input.progress != nullptr) input.progress->advance();
    });
    for (Part& part : parts) take(part);
  }
  if (input.progress != nullptr) input.progress->end();
}

}  // namespace raymoval
