// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"

namespace raymoval {

/// Scans one by one; no implementation holds all scans in memory. Calls are thread-safe.
class ScanSource {
 public:
  virtual ~ScanSource() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;  ///< Number of scans.
  /// Scan `index` (< size()). @throws DataError naming the file and its fault.
  [[nodiscard]] virtual Scan load(std::size_t index) const = 0;
  /// `T_world_sensor` of scan `index`, without reading its points.
  [[nodiscard]] virtual Pose pose(std::size_t index) const = 0;
  [[nodiscard]] virtual const SensorModel& sensor() const = 0;  ///< One for all scans.
};

/// Scans that are made of those of another source. A subclass overrides what it changes.
class DerivedSource : public ScanSource {
 public:
  explicit DerivedSource(std::shared_ptr<const ScanSource> whole) : whole_(std::move(whole)) {}
  [[nodiscard]] std::size_t size() const override { return whole_->size(); }
  [[nodiscard]] Pose pose(std::size_t index) const override { return whole_->pose(index); }
  [[nodiscard]] const SensorModel& sensor() const override { return whole_->sensor(); }
  [[nodiscard]] const ScanSource& whole() const { return *whole_; }

 protected:
  std::shared_ptr<const ScanSource> whole_;
};

/// Label words of a scan: lower 16 bits semantic id, upper 16 bits instance id (SemanticKITTI).
/// Kept apart from `ScanSource` so that no method can reach a label.
class LabelSource {
 public:
  virtual ~LabelSource() = default;
  /// One word per point of `scan`, in its order. Thread-safe.
  /// @throws DataError if the file is missing or its count differs from the scan's.
  [[nodiscard]] virtual std::vector<std::uint32_t> labels(const Scan& scan) const = 0;
};

/// Semantic id of a label word.
constexpr std::uint16_t semantic_id(std::uint32_t word) {
  return static_cast<std::uint16_t>(word & 0xFFFFU);
}

}  // namespace raymoval
