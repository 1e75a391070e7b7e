// SPDX-License-Identifier: MIT
#include <cstring>

#include "datasets/clouds/format/stored_points.h"
#include "datasets/clouds/las/las_fields.h"
#include "datasets/clouds/las/las_head.h"

namespace raymoval {
namespace {

Eigen::Vector3d position_of(const char* record, const LasNotes& notes) {
  std::int32_t steps[3];
  std::memcpy(steps, record, sizeof steps);
  return Eigen::Vector3d(steps[0], steps[1], steps[2]).cwiseProduct(notes.scale) + notes.offset;
}

Cloud read_las_cloud(const CloudBytes& file, const Eigen::Vector3d& origin) {
  const LasHead head = read_las_head(file);
  const std::size_t intensity_at = las_fields(head.format).front().at;
  Cloud cloud;
  cloud.points.resize(head.points);
  cloud.intensity.resize(head.points);
  const char* record = file.text.data() + head.first_point;
  for (std::size_t i = 0; i < head.points; ++i, record += head.record_bytes) {
    cloud.points[i] = (position_of(record, *head.notes) - origin).cast<float>();
    std::uint16_t intensity = 0;
    std::memcpy(&intensity, record + intensity_at, sizeof intensity);
    cloud.intensity[i] = intensity;
  }
  return cloud;
}

RecordLayout layout_of(const LasHead& head) {
  RecordLayout layout;
  for (const char* axis : {"x", "y", "z"}) layout.add(axis, 'F', 8);
  for (const LasField& field : las_fields(head.format))
    layout.add(field.name, field.type, field.size);
  for (const ExtraField& extra : head.extra) {
    layout.add(extra.field.name, extra.field.type, extra.field.size, extra.field.count);
  }
  return layout;
}

/// Writes the fields of a point one after another, in the order of `layout_of`.
void unpack_record(const char* record, const LasHead& head, std::byte* to) {
  const auto put = [&](const void* from, std::size_t bytes) {
    std::memcpy(to, from, bytes);
    to += bytes;
  };
  const Eigen::Vector3d position = position_of(record, *head.notes);
  put(position.data(), 3 * sizeof(double));
  for (const LasField& field : las_fields(head.format)) {
    if (field.bits == 0) {
      put(record + field.at, static_cast<std::size_t>(field.size));
      continue;
    }
    const unsigned all = static_cast<unsigned char>(record[field.at]);
    const auto value = static_cast<std::uint8_t>((all >> field.bit) & ((1U << field.bits) - 1));
    put(&value, 1);
  }
  const char* extra = record + las_record_bytes(head.format);
  for (const ExtraField& field : head.extra) put(extra + field.field.offset, field.field.bytes());
}

PointRecords read_las_records(const CloudBytes& file) {
  const LasHead head = read_las_head(file);
  PointRecords records;
  records.layout = layout_of(head);
  records.width = head.points;
  records.las = head.notes;
  records.bytes.resize(head.points * records.layout.row_bytes);
  const char* record = file.text.data() + head.first_point;
  for (std::size_t i = 0; i < head.points; ++i, record += head.record_bytes) {
    unpack_record(record, head, records.row(i));
  }
  return records;
}

}  // namespace

CloudFormat las_format() {
  CloudFormat format{".las", read_las_cloud, read_las_records, las_encoder, lost_in_las};
  return format;
}

}  // namespace raymoval
