// SPDX-License-Identifier: MIT
#include "datasets/bag_scans/bag_source.h"

#include <utility>

#include "core/error.h"
#include "datasets/bag_scans/topics.h"
#include "datasets/bags/messages/point_cloud.h"
#include "datasets/clouds/returns.h"

namespace raymoval {
std::string scan_name(std::size_t number) {
  constexpr std::size_t kDigits = 6;
  std::string name = std::to_string(number);
  if (name.size() < kDigits) name.insert(0, kDigits - name.size(), '0');
  return name;
}

BagScanSource::BagScanSource(std::shared_ptr<const Bag> bag, std::vector<BagScan> scans,
                             PointFrame point_frame, const std::optional<std::string>& sensor)
    : bag_(std::move(bag)),
      scans_(std::move(scans)),
      point_frame_(point_frame),
      sensor_(sensor),
      tally_(scans_.size()) {}

const BagScan& BagScanSource::scan(std::size_t index) const {
  if (index < scans_.size()) return scans_[index];
  throw InternalError("scan " + std::to_string(index) + " of a sequence of " +
                      std::to_string(scans_.size()));
}

std::string BagScanSource::place(std::size_t index) const {
  return message_place(*bag_, scan(index).topic, scan(index).message);
}

PointRecords BagScanSource::records(std::size_t index) const {
  const BagScan& from = scan(index);
  const BagTopic& topic = bag_->topics()[from.topic];
  return read_points(bag_->message(from.topic, from.message), topic.type, topic.encoding,
                     place(index));
}

Scan BagScanSource::load(std::size_t index) const {
  const BagScan& from = scan(index);
  Scan loaded;
  loaded.index = index;
  loaded.name = scan_name(from.number);
  loaded.time_s = from.time_s;
  loaded.T_world_sensor = from.T_world_sensor;
  const std::string where = place(index);
  const ReturnCounts counts =
      read_returns(loaded, point_frame_, where, [&](const Eigen::Vector3d& origin) {
        const BagTopic& topic = bag_->topics()[from.topic];
        return read_point_positions(bag_->message(from.topic, from.message), topic.type,
                                    topic.encoding, origin, where);
      });
  tally_.set(index, counts.stored, counts.no_returns);
  return loaded;
}

const SensorModel& BagScanSource::sensor() const {
  return sensor_.get(size(), [this](std::size_t index) { return load(index); });
}

}  // namespace raymoval
