// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "benchmark/suite/suite.h"
#include "python/module/array_source.h"
#include "python/module/scans.h"

namespace raymoval::python {

/// A sequence as Python sees it.
struct HeldSequence {
  std::shared_ptr<const Sequence> sequence;
  std::shared_ptr<const Truth> truth;
  /// Where it was opened. No value for arrays, which a run cannot open again.
  std::optional<SequenceRequest> place = std::nullopt;
  /// The scans if they are arrays; else null.
  std::shared_ptr<const ArraySource> arrays = nullptr;

  /// Number of values that a mask of a scan has: one for each row of an array, and one for each
  /// point of an opened scan.
  /// @param scan as it was loaded
  [[nodiscard]] std::size_t mask_size(const Scan& scan) const {
    return arrays ? scan.stored_point_count : scan.size();
  }
};

}  // namespace raymoval::python
