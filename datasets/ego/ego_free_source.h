// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "core/scan/scan_source.h"
#include "datasets/clouds/file_source.h"
#include "datasets/ego/ego_region.h"

namespace raymoval {

/// Scans of another source without the points of the machine that carries the sensor. They are left
/// out of `Scan` as missing returns are: `stored_index` tells where the others stand.
class EgoFreeSource : public ScanSource {
 public:
  /// @param asked the region; of kind kEstimated: it is found when first needed, in up to twenty
  ///   scans of `whole`
  EgoFreeSource(std::shared_ptr<const ScanSource> whole, EgoRegion asked);

  [[nodiscard]] std::size_t size() const override { return whole_->size(); }
  /// @throws DataError also if no point is left, or the region cannot be estimated
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return whole_->pose(index); }
  /// A sensor that is estimated is so from what is left of the scans.
  [[nodiscard]] const SensorModel& sensor() const override;

  [[nodiscard]] const ScanSource& whole() const { return *whole_; }
  [[nodiscard]] const EgoRegion& asked() const { return asked_; }
  /// The region as used; of kind kNone if nothing was found. @throws DataError as `load`
  [[nodiscard]] const EgoRegion& region() const;
  [[nodiscard]] const LeftOutTally& tally() const { return tally_; }

 private:
  std::shared_ptr<const ScanSource> whole_;
  EgoRegion asked_;
  SensorChoice sensor_;
  LeftOutTally tally_;
  mutable std::once_flag once_;
  mutable EgoRegion region_;
};

}  // namespace raymoval
