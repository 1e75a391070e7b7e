// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/scan_spool.h"
#include "python/module/array_source.h"

namespace raymoval::python {

/// Keeps points in a file without a name below TMPDIR (else /tmp): 12 bytes a point, 16 with
/// reflectance.
class PointSpool : public PointStore {
 public:
  /// @throws DataError if the file cannot be made
  PointSpool();
  /// Adds the next scan; no other thread reads meanwhile. @throws DataError if the disk is full
  void add(const Cloud& cloud);
  [[nodiscard]] std::size_t size() const override { return points_.size(); }
  /// @throws DataError if the file cannot be read
  [[nodiscard]] Cloud points(std::size_t scan) const override;

 private:
  ScanSpool points_, intensities_;
};

}  // namespace raymoval::python
