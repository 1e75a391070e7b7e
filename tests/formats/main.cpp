// SPDX-License-Identifier: MIT
// Reads and writes point records for tests/formats/formats.py.
//
//   raymoval_formats dump FILE [POINT_LAYOUT]         a line for each field, then the rows in hex
//   raymoval_formats convert IN OUT [POINT_LAYOUT]    writes the records of IN to OUT
#include <cstdio>
#include <string>

#include "core/error.h"
#include "datasets/clouds/record_file.h"

namespace {

void dump(const raymoval::PointRecords& records) {
  for (const raymoval::PointField& field : records.layout.fields) {
    std::printf("%c %d %d %zu %s\n", field.type, field.size, field.count, field.offset,
                field.name.c_str());
  }
  std::printf("\n%zu\n", records.layout.row_bytes);
  for (const std::byte byte : records.bytes) std::printf("%02x", std::to_integer<unsigned>(byte));
  std::printf("\n");
}

}  // namespace

int main(int count, char** words) {
  const std::string command = count > 2 ? words[1] : "";
  const int named = command == "convert" ? 4 : 3;
  if (count < named || count > named + 1) {
    std::fprintf(stderr, "expected: dump FILE [POINT_LAYOUT], or convert IN OUT [POINT_LAYOUT]\n");
    return 2;
  }
  try {
    raymoval::RecordReading reading;
    if (count > named) reading.point_layout = words[named];
    const raymoval::PointRecords records = raymoval::read_records(words[2], reading);
    if (command == "dump") {
      dump(records);
      return 0;
    }
    raymoval::PointRecordWriter writer(words[3]);
    writer.start(records.layout);
    writer.add(records);
    writer.finish();
    writer.commit();
    return 0;
  } catch (const raymoval::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.exit_code());
  }
}
