// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "core/scan/label_rule.h"
#include "core/scan/scan_source.h"
#include "python/module/shared_object.h"

namespace raymoval::python {

/// What says which points of a scan move. Methods never get it.
struct Truth {
  std::shared_ptr<const LabelSource> labels;  ///< Null if the data has none.
  LabelRule rule;
};

/// A scan as Python sees it. Its arrays are views of it and keep it alive.
struct HeldScan {
  Scan scan;
  std::shared_ptr<const Truth> truth = nullptr;  ///< Null for methods.
};

/// `index` as a position in a sequence; a negative one counts from the end.
/// @throws py::index_error
std::size_t position(py::ssize_t index, std::size_t size);

/// What iter() gives for a class with __getitem__.
py::object iterator_over(const py::object& sequence);

/// The poses of all scans.
std::vector<Pose> poses_of(const ScanSource& scans);

}  // namespace raymoval::python
