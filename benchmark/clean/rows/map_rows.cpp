// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/map_rows.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "core/scan/confidence_store.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/clouds/las/las_head.h"
#include "datasets/records/number_types.h"

namespace raymoval {
namespace {

constexpr std::uint64_t kRowsPerBlock = 16384;
constexpr std::size_t kCellsPerPiece = 65536;

bool is_position(const PointField& field) {
  constexpr std::string_view kAxes = "xyzXYZ";
  return field.count == 1 && field.name.size() == 1 &&
         kAxes.find(field.name) != std::string_view::npos;
}

/// The bytes of x, y or z in a map whose points are not the stored ones.
int coordinate_size(const PointField& stored, Coordinates coordinates) {
  if (coordinates == Coordinates::kDouble) return 8;
  return stored.type == 'F' ? stored.size : 4;
}

const PointField* named(const RecordLayout& layout, const std::string& name) {
  return layout.find({name});
}

bool same_kind(const PointField& a, const PointField& b) {
  return a.type == b.type && a.size == b.size && a.count == b.count;
}

bool is_real(const PointField* field, int count) {
  return field != nullptr && field->type == 'F' && field->count == count;
}

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

VoxelRows::VoxelRows(const RecordLayout& layout, double cell_size, const Eigen::Vector3d& origin)
    : layout_(layout),
      at_(position_fields(layout, "a map")),
      keeps_rows_(layout.fields.size() > 3),
      cell_size_(cell_size),
      origin_(origin) {
  if (const PointField* found = intensity_field(layout)) {
    intensity_ = *found;
    keeps_rows_ = layout.fields.size() > 4;
  }
}

std::byte* VoxelRows::row_of(const Cell& cell) const {
  return blocks_[cell.row / kRowsPerBlock].get() + cell.row % kRowsPerBlock * layout_.row_bytes;
}

void VoxelRows::keep_row(Cell& cell, bool is_new, const std::byte* row) {
  if (is_new) {
    cell.row = cells_.size() - 1;
    if (cell.row % kRowsPerBlock == 0) {
      blocks_.push_back(std::make_unique<std::byte[]>(kRowsPerBlock * layout_.row_bytes));
    }
  }
  std::memcpy(row_of(cell), row, layout_.row_bytes);
}

void VoxelRows::add(const ScanRows& scan, std::size_t point) {
  if (las_ == nullptr) las_ = scan.rows.las;
  const Eigen::Vector3d offset = scan.world[point] - origin_;
  const VoxelIndex index = voxel_index(offset, 1.0 / cell_size_);
  const auto [place, is_new] = cells_.try_emplace(voxel_key(index));
  Cell& cell = place.value();
  cell.sum += offset;
  if (intensity_) cell.intensity += scan.rows.value(point, *intensity_);
  ++cell.count;
  if (!keeps_rows_) return;
  const Eigen::Vector3d from_middle =
      offset / cell_size_ - index.cast<double>() - Eigen::Vector3d::Constant(0.5);
  const auto distance = static_cast<float>(from_middle.squaredNorm());
  if (!(distance < cell.from_middle)) return;
  cell.from_middle = distance;
  keep_row(cell, is_new, scan.rows.row(point));
}

void VoxelRows::append(const Cell& cell, ScanRows& piece) const {
  const std::size_t place = piece.world.size();
  const auto count = static_cast<double>(cell.count);
  piece.world.push_back(origin_ + cell.sum / count);
  piece.rows.bytes.resize(piece.rows.bytes.size() + layout_.row_bytes);
  piece.rows.width = place + 1;
  if (keeps_rows_) std::memcpy(piece.rows.row(place), row_of(cell), layout_.row_bytes);
  const Eigen::Vector3d& mean = piece.world.back();
  piece.rows.set_value(place, at_.x, mean.x());
  piece.rows.set_value(place, at_.y, mean.y());
  piece.rows.set_value(place, at_.z, mean.z());
  if (intensity_) piece.rows.set_value(place, *intensity_, cell.intensity / count);
}

void VoxelRows::take(const std::function<void(const ScanRows& piece)>& give) {
  std::vector<VoxelKey> keys;
  keys.reserve(cells_.size());
  for (const auto& [key, cell] : cells_) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  for (std::size_t first = 0; first < keys.size(); first += kCellsPerPiece) {
    ScanRows piece{{layout_, {}, 0, 1}, {}};
    piece.rows.las = las_;
    const std::size_t end = std::min(keys.size(), first + kCellsPerPiece);
    piece.rows.bytes.reserve((end - first) * layout_.row_bytes);
    for (std::size_t i = first; i < end; ++i) append(cells_.at(keys[i]), piece);
    give(piece);
  }
  cells_.clear();
  blocks_.clear();
}

RecordLayout map_layout(const RecordLayout& stored, PointFrame frame, Coordinates coordinates,
                        const std::string& where) {
  position_fields(stored, where);
  if (frame == PointFrame::kWorld) return stored;
  const bool fits = std::all_of(stored.fields.begin(), stored.fields.end(), [&](const auto& field) {
    return !is_position(field) ||
           (field.type == 'F' && field.size == coordinate_size(field, coordinates));
  });
  if (fits) return stored;
  RecordLayout layout;
  for (const PointField& field : stored.fields) {
    if (is_position(field)) {
      layout.add(field.name, 'F', coordinate_size(field, coordinates));
    } else {
      layout.add(field.name, field.type, field.size, field.count);
    }
  }
  return layout;
}

RecordLayout plain_layout(Coordinates coordinates) {
  RecordLayout layout;
  for (const char* axis : {"x", "y", "z"}) {
    layout.add(axis, 'F', coordinates == Coordinates::kDouble ? 8 : 4);
  }
  layout.add("intensity", 'F', 4);
  return layout;
}

std::string field_difference(const RecordLayout& layout, const RecordLayout& expected) {
  for (const PointField& field : expected.fields) {
    const PointField* found = named(layout, field.name);
    if (found == nullptr) return "has no field '" + field.name + "'";
    if (!same_kind(*found, field)) return "has " + found->text() + " in place of " + field.text();
  }
  for (const PointField& field : layout.fields) {
    if (named(expected, field.name) == nullptr) return "has a field '" + field.name + "' as well";
  }
  return "";
}

std::vector<NormalFields> normal_fields(const RecordLayout& layout) {
  std::vector<NormalFields> normals;
  for (const auto& names :
       {std::array{"normal_x", "normal_y", "normal_z"}, std::array{"nx", "ny", "nz"}}) {
    const PointField *x = layout.find({names[0]}), *y = layout.find({names[1]}),
                     *z = layout.find({names[2]});
    if (is_real(x, 1) && is_real(y, 1) && is_real(z, 1)) normals.push_back({*x, *y, *z});
  }
  const PointField* whole = layout.find({"normal"});
  if (!is_real(whole, 3)) return normals;
  NormalFields parts{*whole, *whole, *whole};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].count = 1;
    parts[i].offset += i * static_cast<std::size_t>(whole->size);
  }
  normals.push_back(parts);
  return normals;
}

const PointField* intensity_field(const RecordLayout& layout) {
  for (const std::string_view name : intensity_names()) {
    const PointField* field = layout.find({name});
    if (field != nullptr && field->count == 1) return field;
  }
  return nullptr;
}

RowCopy::RowCopy(const RecordLayout& from, const RecordLayout& to) {
  if (from == to) {
    is_whole_ = true;
    pieces_ = {{0, 0, from.row_bytes}};
    return;
  }
  for (const PointField& field : to.fields) {
    const PointField* source = named(from, field.name);
    if (source == nullptr || !same_kind(*source, field)) continue;
    const Piece piece{source->offset, field.offset, field.bytes()};
    const bool goes_on = !pieces_.empty() &&
                         pieces_.back().from + pieces_.back().bytes == piece.from &&
                         pieces_.back().to + pieces_.back().bytes == piece.to;
    if (goes_on) {
      pieces_.back().bytes += piece.bytes;
    } else {
      pieces_.push_back(piece);
    }
  }
}

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

std::shared_ptr<const LasNotes> MapRows::las_notes(const PointRecords& stored) const {
  if (stored.las == nullptr || frame_ == PointFrame::kWorld) return stored.las;
  // A grid of 0.1 mm covers 200 km; the grid of a scan may only cover the surroundings of the
  // sensor.
  constexpr double kFinest = 1e-4;
  auto notes = std::make_shared<LasNotes>(*stored.las);
  notes->scale = notes->scale.cwiseAbs().cwiseMax(kFinest);
  return notes;
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
    result.rows.las = las_notes(*stored);
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

RecordLayout layout_with_confidence(const RecordLayout& layout) {
  std::string name = "confidence";
  while (layout.find({name}) != nullptr) name = "raymoval_" + name;
  RecordLayout more = layout;
  more.add(std::move(name), 'F', sizeof(float));
  return more;
}

ScanRows rows_with_confidence(const ScanRows& rows, const RecordLayout& layout,
                              const std::string& steps) {
  const std::size_t size = rows.rows.size(), bytes = rows.rows.layout.row_bytes;
  ScanRows result{{layout, std::vector<std::byte>(size * layout.row_bytes), size, 1}, rows.world};
  result.rows.las = rows.rows.las;
  for (std::size_t i = 0; i < size; ++i) {
    const float value = confidence_of_steps(static_cast<std::uint8_t>(steps[i]));
    std::memcpy(result.rows.row(i), rows.rows.row(i), bytes);
    std::memcpy(result.rows.row(i) + bytes, &value, sizeof value);
  }
  return result;
}

}  // namespace raymoval
