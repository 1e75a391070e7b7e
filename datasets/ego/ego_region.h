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

/// The region of the sensor frame (metres) of the machine that carries the sensor. Its points move
/// along with the sensor, and methods would classify them as static.
struct EgoRegion {
  enum class Kind {
    kNone,       ///< No point is left out.
    kEstimated,  ///< Estimated from the scans, see `estimate_ego`.
    kRadius,     ///< Points nearer than `radius`.
    kBox,        ///< Points within `box`, its faces included.
  };
  Kind kind = Kind::kNone;
  double radius = 0.0;
  Eigen::AlignedBox3d box;

  /// Whether the region contains a point of the sensor frame; false for kNone and kEstimated.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const {
    if (kind == Kind::kRadius) return point.squaredNorm() < radius * radius;
    return kind == Kind::kBox && box.contains(point);
  }
};

/// Parses "none", "auto" (estimated), a radius ("2.4"), or a box ("-1:2,-0.9:0.9,-1.5:0.2" along x,
/// y and z of the sensor frame, an empty side open). @throws UsageError listing these forms
EgoRegion parse_ego_region(const std::string& text);

/// The text that `parse_ego_region` reads.
std::string ego_region_text(const EgoRegion& region);

/// Scans of another source without the points of the ego vehicle. These are left out of `Scan` like
/// missing returns: `stored_index` has the stored positions of the other points.
class EgoFreeSource : public DerivedSource {
 public:
  /// @param asked the region; kind kEstimated is estimated at first use from up to twenty scans of
  ///   `whole`
  /// @param up in the world; if it is not given, it is estimated with the region
  EgoFreeSource(std::shared_ptr<const ScanSource> whole, EgoRegion asked,
                std::optional<Eigen::Vector3d> up = std::nullopt);

  /// @throws DataError also if no point is left, or the region cannot be estimated
  [[nodiscard]] Scan load(std::size_t index) const override;
  /// An estimated sensor model is estimated from the remaining points.
  [[nodiscard]] const SensorModel& sensor() const override;

  [[nodiscard]] const EgoRegion& asked() const { return asked_; }
  /// The region as used; of kind kNone if nothing was found. @throws DataError as `load`
  [[nodiscard]] const EgoRegion& region() const;
  [[nodiscard]] const LeftOutTally& tally() const { return tally_; }

 private:
  EgoRegion asked_;
  std::optional<Eigen::Vector3d> up_;
  SensorChoice sensor_;
  LeftOutTally tally_;
  mutable std::once_flag once_;
  mutable EgoRegion region_;
};

}  // namespace raymoval
