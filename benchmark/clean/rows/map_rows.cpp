// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/map_rows.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/error.h"
#include "core/scan/confidence_store.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/records/number_types.h"

namespace raymoval {
namespace {

/// Reads a field of the stored rows that `scan` has points of, one after another.
void read_axis(const Scan& scan, const PointRecords& stored, const PointField& field, int axis,
               std::vector<Eigen::Vector3d>& values) {
  with_number_type(field.type, field.size, [&](auto zero) {
    decltype(zero) number{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::memcpy(&number, stored.row(scan.stored_position(i)) + field.offset, sizeof number);
      values[i][axis] = static_cast<double>(number);
    }
  });
}

void write_axis(const std::vector<Eigen::Vector3d>& values, const PointField& field, int axis,
                PointRecords& rows) {
  std::byte* to = rows.bytes.data() + field.offset;
  with_number_type(field.type, field.size, [&](auto zero) {
    for (const Eigen::Vector3d& value : values) {
      const auto number = static_cast<decltype(zero)>(value[axis]);
      std::memcpy(to, &number, sizeof number);
      to += rows.layout.row_bytes;
    }
  });
}

/// Whether x, y and z are adjacent float32 values, as in most scans.
bool are_plain(const PositionFields& at) {
  const auto is_float = [](const PointField& field) {
    return field.type == 'F' && field.size == 4;
  };
  return is_float(at.x) && is_float(at.y) && is_float(at.z) && at.y.offset == at.x.offset + 4 &&
         at.z.offset == at.x.offset + 8;
}

void write_positions(const std::vector<Eigen::Vector3d>& world, PointRecords& rows) {
  const PositionFields at = position_fields(rows.layout, "a map");
  if (are_plain(at)) {
    std::byte* to = rows.bytes.data() + at.x.offset;
    for (const Eigen::Vector3d& point : world) {
      const Eigen::Vector3f rounded = point.cast<float>();
      std::memcpy(to, rounded.data(), 3 * sizeof(float));
      to += rows.layout.row_bytes;
    }
    return;
  }
  write_axis(world, at.x, 0, rows);
  write_axis(world, at.y, 1, rows);
  write_axis(world, at.z, 2, rows);
}

bool is_double(const PositionFields& at) {
  const auto is = [](const PointField& field) { return field.type == 'F' && field.size == 8; };
  return is(at.x) && is(at.y) && is(at.z);
}

PointRecords empty_rows(const RecordLayout& layout, std::size_t count) {
  PointRecords rows{layout, std::vector<std::byte>(count * layout.row_bytes), count, 1};
  return rows;
}

PointRecords plain_rows(const Scan& scan, const RecordLayout& layout) {
  PointRecords rows = empty_rows(layout, scan.size());
  const PointField* intensity = intensity_field(layout);
  if (intensity == nullptr || scan.reflectance.empty()) return rows;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    std::memcpy(rows.row(i) + intensity->offset, &scan.reflectance[i], sizeof(float));
  }
  return rows;
}

/// The stored rows that `scan` has points of, in another layout.
PointRecords copied_rows(const Scan& scan, const PointRecords& stored, const RecordLayout& layout) {
  const RowCopy copy(stored.layout, layout);
  if (copy.is_whole() && scan.stored_index.empty() && !scan.points.empty())
    return {layout, stored.bytes, scan.size(), 1};
  PointRecords rows = empty_rows(layout, scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    copy.copy(stored.row(scan.stored_position(i)), rows.row(i));
  }
  return rows;
}

}  // namespace

MapRows::MapRows(const Sequence& sequence, Coordinates coordinates, Progress& progress,
                 const std::atomic<bool>& cancel)
    : sequence_(sequence) {
  if (sequence.records == nullptr) {
    layout_ = plain_layout(coordinates);
    is_widened_ = coordinates == Coordinates::kDouble;
    return;
  }
  check_fields(sequence, progress, cancel);
  frame_ = sequence.records->point_frame();
  layout_ = map_layout(stored_, frame_, coordinates, sequence.records->place(0));
  is_widened_ = coordinates == Coordinates::kDouble && !(layout_ == stored_);
  if (frame_ == PointFrame::kSensor) normals_ = normal_fields(layout_);
}

void MapRows::check_fields(const Sequence& sequence, Progress& progress,
                           const std::atomic<bool>& cancel) {
  const RecordSource& records = *sequence.records;
  progress.begin("looking at the fields of the scans", sequence.scans->size());
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    if (cancel) throw Cancelled();
    RecordLayout layout = records.layout(i);
    if (i == 0) stored_ = std::move(layout);
    const std::string difference = i == 0 ? "" : field_difference(layout, stored_);
    if (!difference.empty()) {
      throw DataError(records.place(i) + ": " + difference + ", unlike the first scan (" +
                      records.place(0) +
                      "). The points of a map all have the same fields, so nothing was written. "
                      "Write all scans with the same fields.");
    }
    progress.advance();
  }
  progress.end();
}

std::vector<Eigen::Vector3d> MapRows::world_points(const Scan& scan,
                                                   const PointRecords* stored) const {
  std::vector<Eigen::Vector3d> points(scan.size());
  if (stored != nullptr) {
    const PositionFields at = position_fields(stored->layout, "a scan");
    const bool as_stored = frame_ == PointFrame::kWorld || is_double(at);
    if (as_stored) {
      read_axis(scan, *stored, at.x, 0, points);
      read_axis(scan, *stored, at.y, 1, points);
      read_axis(scan, *stored, at.z, 2, points);
    }
    if (frame_ == PointFrame::kWorld) return points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      // A point that was moved, such as by --deskew, has only the digits that `scan` holds.
      const bool moved = !as_stored || points[i].cast<float>() != scan.points[i];
      points[i] = scan.T_world_sensor * (moved ? scan.points[i].cast<double>() : points[i]);
    }
    return points;
  }
  std::transform(scan.points.begin(), scan.points.end(), points.begin(), [&](const auto& point) {
    return scan.T_world_sensor * point.template cast<double>();
  });
  return points;
}

void MapRows::turn_normals(const Scan& scan, PointRecords& rows) const {
  const Eigen::Matrix3d turn = scan.T_world_sensor.linear();
  for (const NormalFields& normal : normals_) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      Eigen::Vector3d direction;
      for (int axis = 0; axis < 3; ++axis) direction[axis] = rows.value(i, normal[axis]);
      direction = turn * direction;
      for (int axis = 0; axis < 3; ++axis) rows.set_value(i, normal[axis], direction[axis]);
    }
  }
}

ScanRows MapRows::rows(const Scan& scan, const PointRecords* stored) const {
  ScanRows result;
  if (stored == nullptr) {
    result.rows = plain_rows(scan, layout_);
  } else {
    const std::string difference = field_difference(stored->layout, stored_);
    if (!difference.empty() || stored->size() != scan.stored_point_count) {
      throw DataError(sequence_.records->place(scan.index) +
                      ": has changed since it was first read. Nothing was written; start again "
                      "when no program writes there.");
    }
    result.rows = copied_rows(scan, *stored, layout_);
  }
  result.world = world_points(scan, stored);
  if (stored == nullptr || frame_ == PointFrame::kSensor) {
    write_positions(result.world, result.rows);
    turn_normals(scan, result.rows);
  }
  return result;
}

MapPrecision map_precision(const ScanSource& scans) {
  MapPrecision precision;
  precision.origin = lattice_origin(scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans.pose(i).translation().cwiseAbs().maxCoeff() > kFarFromOrigin) {
      precision.coordinates = Coordinates::kDouble;
    }
  }
  return precision;
}

RecordLayout layout_with_field(const RecordLayout& layout, std::string name, char type, int size) {
  while (layout.find({name}) != nullptr) name = "raymoval_" + name;
  RecordLayout more = layout;
  more.add(std::move(name), type, size);
  return more;
}

RecordLayout layout_with_confidence(const RecordLayout& layout) {
  return layout_with_field(layout, "confidence", 'F', sizeof(float));
}

ScanRows rows_with_confidence(const ScanRows& rows, const RecordLayout& layout,
                              const std::string& steps) {
  return rows_with_field(rows, layout, [&](std::size_t i) {
    return confidence_of_steps(static_cast<std::uint8_t>(steps[i]));
  });
}

}  // namespace raymoval
