// SPDX-License-Identifier: MIT
#include "datasets/sequence.h"

#include <nlohmann/json.hpp>

#include "core/scan/local_frame.h"
#include "datasets/ego/ego_free_source.h"
#include "datasets/world_axes/gravity.h"

namespace raymoval {

UpDirection Sequence::up() const {
  // From the scans as they were opened: reading them for this does not count as a method's reading.
  return up_choice ? up_choice->get(opened ? *opened : *scans) : UpDirection{};
}

Pose Sequence::method_frame() const {
  return raymoval::method_frame(*scans, up().direction);
}

Pose Sequence::upright_frame() const {
  Pose T_upright_world = Pose::Identity();
  T_upright_world.linear() = turn_to_z(up().direction);
  return T_upright_world;
}

nlohmann::ordered_json Sequence::record() const {
  nlohmann::ordered_json record;
  record["name"] = name;
  record["layout"] = layout;
  record["source"] = source;
  record["frames"] = frames;
  record["scans"] = scans->size();
  record["poses"] = poses_file;
  record["sensor"] = scans->sensor().name;
  if (scans->sensor().is_estimated()) record["sensor_basis"] = scans->sensor().basis;
  record["up"] = up_text(up().direction);
  record["up_source"] = up_source_name(up().source);
  record["scan_period_s"] = nullptr;
  if (scan_period_s) record["scan_period_s"] = *scan_period_s;
  record["range_m"] = {{"min", range_m.min}, {"max", nullptr}};
  if (range_m.max < RangeLimits{}.max) record["range_m"]["max"] = range_m.max;
  if (const EgoFreeSource* without_ego = ego_free_source(*this)) {
    record["drop_ego"] = {{"asked", ego_region_text(without_ego->asked())},
                          {"left_out", ego_region_text(without_ego->region())}};
  }
  record["label_rule"] = nullptr;
  if (labels) record["label_rule"] = to_json(label_rule);
  return record;
}

const EgoFreeSource* ego_free_source(const Sequence& sequence) {
  return dynamic_cast<const EgoFreeSource*>(
      (sequence.opened ? sequence.opened : sequence.scans).get());
}

const FileScanSource* file_source(const Sequence& sequence) {
  const ScanSource* source = (sequence.opened ? sequence.opened : sequence.scans).get();
  if (const EgoFreeSource* without_ego = ego_free_source(sequence)) source = &without_ego->whole();
  return dynamic_cast<const FileScanSource*>(source);
}

}  // namespace raymoval
