// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scan/scan_source.h"
#include "datasets/bags/bag.h"
#include "datasets/clouds/file_source.h"
#include "datasets/records/record_source.h"

namespace raymoval {

/// A message with a scan, without its points.
struct BagScan {
  std::size_t topic = 0;    ///< Number of its topic in the bag.
  std::size_t message = 0;  ///< Its number in the topic.
  std::size_t number = 0;   ///< In its name: `message`, or its position in time of several topics.
  std::size_t sensor = 0;   ///< Position of its topic among the topics that are read.
  double time_s = 0.0;      ///< Since the first message of the topics.
  Pose T_world_sensor = Pose::Identity();
  std::shared_ptr<const RecordLayout> layout = nullptr;  ///< Of its points, shared by scans.
};

/// Scans that are messages of a bag, with all their fields. Points that are no returns are left out
/// (see `read_returns`). A scan is read when it is requested.
class BagScanSource : public ScanSource, public RecordSource, public TalliedSource {
 public:
  BagScanSource(std::shared_ptr<const Bag> bag, std::vector<BagScan> scans, PointFrame point_frame,
                const std::optional<std::string>& sensor);

  [[nodiscard]] std::size_t size() const override { return scans_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return scan(index).T_world_sensor; }
  [[nodiscard]] const SensorModel& sensor() const override;
  [[nodiscard]] PointRecords records(std::size_t index) const override;
  [[nodiscard]] RecordLayout layout(std::size_t index) const override {
    return *scan(index).layout;
  }
  [[nodiscard]] PointFrame point_frame() const override { return point_frame_; }
  [[nodiscard]] std::string place(std::size_t index) const override;
  [[nodiscard]] const Bag& bag() const { return *bag_; }
  [[nodiscard]] const LeftOutTally& tally() const override { return tally_; }

 private:
  [[nodiscard]] const BagScan& scan(std::size_t index) const;

  std::shared_ptr<const Bag> bag_;
  std::vector<BagScan> scans_;
  PointFrame point_frame_;
  SensorChoice sensor_;
  LeftOutTally tally_;
};

/// "000012".
std::string scan_name(std::size_t number);

}  // namespace raymoval
