// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/scan/scan_source.h"
#include "datasets/clouds/file_source.h"

namespace raymoval {

/// The part of the sensor frame (metres) whose points belong to the machine that carries the
/// sensor: points there go along with it, and methods take them for things that are always there.
struct EgoRegion {
  enum class Kind {
    kNone,       ///< No point is left out.
    kEstimated,  ///< To be found in the scans, see `estimate_ego`.
    kRadius,     ///< Points nearer than `radius`.
    kBox,        ///< Points within `box`, its faces included.
  };
  Kind kind = Kind::kNone;
  double radius = 0.0;
  Eigen::AlignedBox3d box;

  /// Whether a point of the sensor frame lies in it; never for the first two kinds.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const {
    if (kind == Kind::kRadius) return point.squaredNorm() < radius * radius;
    return kind == Kind::kBox && box.contains(point);
  }
};

/// Reads "none", "auto" (estimated), a radius ("2.4"), or a box ("-1:2,-0.9:0.9,-1.5:0.2" along x,
/// y and z of the sensor frame, an empty side open). @throws UsageError saying what the forms are
EgoRegion parse_ego_region(const std::string& text);

/// What `parse_ego_region` reads.
std::string ego_region_text(const EgoRegion& region);

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
