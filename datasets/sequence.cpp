// SPDX-License-Identifier: MIT
#include "datasets/sequence.h"

#include "core/scan/local_frame.h"
#include "datasets/deskew/deskew.h"
#include "datasets/ego/ego_region.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {

UpDirection Sequence::up() const {
  return up_choice ? up_choice->get(as_opened()) : UpDirection{};
}

Pose Sequence::method_frame() const {
  return raymoval::method_frame(*scans, up().direction);
}

Pose Sequence::upright_frame() const {
  Pose T_upright_world = Pose::Identity();
  T_upright_world.linear() = turn_to_z(up().direction);
  return T_upright_world;
}

namespace {

/// The source that corrects motion within scans; null if there is none.
const DeskewedSource* deskewed_source(const Sequence& sequence) {
  return dynamic_cast<const DeskewedSource*>(&sequence.as_opened());
}

/// The scans as opened, before motion within scans is corrected.
const ScanSource* skewed_source(const Sequence& sequence) {
  if (const DeskewedSource* deskewed = deskewed_source(sequence)) return &deskewed->whole();
  return &sequence.as_opened();
}

}  // namespace

DataRecord Sequence::record() const {
  DataRecord data{name,
                  layout,
                  source,
                  frames,
                  scans->size(),
                  poses_file,
                  scans->sensor().name,
                  scans->sensor().basis};
  data.up = axis_text(up().direction);
  data.up_source = up_source_name(up().source);
  data.scan_period_s = scan_period_s;
  data.range_m = range_m;
  if (const EgoFreeSource* without_ego = ego_free_source(*this)) {
    data.drop_ego = {ego_region_text(without_ego->asked()), ego_region_text(without_ego->region())};
  }
  if (T_sensor) data.T_sensor = std::filesystem::path(*T_sensor).filename().string();
  if (sensor_origin) data.sensor_origin = sensor_places_text(*sensor_origin);
  data.time_offset_s = time_offset_s;
  if (const DeskewedSource* deskewed = deskewed_source(*this)) data.deskew = deskewed->clock().text;
  if (labels) data.label_rule = label_rule;
  for (const auto* lines : {&damage, &losses}) {
    for (const std::string& line : *lines) {
      const std::size_t place = line.rfind('/', line.find(": "));
      data.losses.push_back(place == std::string::npos ? line : line.substr(place + 1));
    }
  }
  return data;
}

const EgoFreeSource* ego_free_source(const Sequence& sequence) {
  return dynamic_cast<const EgoFreeSource*>(skewed_source(sequence));
}

const ScanSource& stored_source(const Sequence& sequence) {
  const ScanSource* source = &sequence.as_opened();
  while (const auto* derived = dynamic_cast<const DerivedSource*>(source)) {
    source = &derived->whole();
  }
  return *source;
}

const FileScanSource* file_source(const Sequence& sequence) {
  return dynamic_cast<const FileScanSource*>(&stored_source(sequence));
}

}  // namespace raymoval
