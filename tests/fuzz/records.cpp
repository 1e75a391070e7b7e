// SPDX-License-Identifier: MIT
// Clouds with all their fields, in every format, and layouts of points.
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/format/field_names.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

PointRecords write_and_read(const PointRecords& records, const std::string& name,
                            const RecordReading& reading = {}) {
  const auto path = input_file(name, "");
  PointRecordWriter writer(path);
  writer.start(records.layout);
  writer.add(records);
  writer.finish();
  writer.commit();
  return read_records(path, reading);
}

/// What was read is written to the formats that hold everything, and reads back the same.
void check_round_trips(const PointRecords& records) {
  const PointRecords npy = write_and_read(records, "again.npy");
  require(npy.bytes == records.bytes, "records change in .npy");
  require(npy.layout.row_bytes == records.layout.row_bytes, "a layout changes in .npy");
  const PointRecords pcd = write_and_read(records, "again.pcd");
  require(pcd.bytes == records.bytes, "records change in .pcd");
  const PointRecords bin =
      write_and_read(records, "again.bin", {point_layout_text(records.layout)});
  require(bin.bytes == records.bytes, "records change in .bin");
  (void)write_and_read(records, "again.ply");
  // Coordinates that LAS cannot hold are refused, and records too long for it.
  may_refuse([&] {
    const PointRecords las = write_and_read(records, "again.las");
    require(las.size() == records.size(), "points are lost in .las");
  });
}

/// Tries `bytes` as the file `name`: with all its fields, and as a cloud.
void try_records(const std::string& name, std::string_view bytes, const RecordReading& reading) {
  const auto path = input_file(name, bytes);
  may_refuse([&] {
    const PointRecords records = read_records(path, reading);
    require(records.bytes.size() == records.size() * records.layout.row_bytes,
            "records have a part of a row");
    require(records.width * records.height == records.size(), "rows and columns are no points");
    const Cloud cloud = read_cloud(path, Eigen::Vector3d::Zero(), reading);
    require(cloud.points.size() == records.size(), "records and points differ in number");
    if (records.size() > 0 && records.layout.fields.size() < 200) check_round_trips(records);
  });
  may_refuse([&] { (void)read_cloud(path, Eigen::Vector3d(1, 2, 3), reading); });
}

RAYMOVAL_FUZZ_TARGET(pcd_records) {
  try_records("scan.pcd", bytes, {});
}

RAYMOVAL_FUZZ_TARGET(ply_records) {
  try_records("scan.ply", bytes, {});
}

RAYMOVAL_FUZZ_TARGET(las) {
  try_records("scan.las", bytes, {});
}

RAYMOVAL_FUZZ_TARGET(npy) {
  try_records("scan.npy", bytes, {});
  try_records("scan.npy", bytes, {"x y z intensity"});
}

RAYMOVAL_FUZZ_TARGET(npz) {
  try_records("scan.npz", bytes, {});
}

RAYMOVAL_FUZZ_TARGET(point_layout) {
  may_refuse([&] {
    const RecordLayout layout = parse_point_layout(bytes);
    const RecordLayout again = parse_point_layout(point_layout_text(layout));
    require(again.row_bytes == layout.row_bytes && again.fields == layout.fields,
            "a layout changes when written and read");
    // Rows of 100,000 numbers take seconds in each of the formats that they are written to.
    if (layout.row_bytes > 65536) return;
    try_records("scan.bin", std::string(2 * layout.row_bytes, '\x3F'), {std::string(bytes)});
  });
}

}  // namespace
}  // namespace raymoval::fuzz
