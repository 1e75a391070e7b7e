// SPDX-License-Identifier: MIT
// Reads and writes point records, sequences and recordings for the scripts in this folder.
//
//   raymoval_formats dump FILE [POINT_LAYOUT]         the fields and rows of a cloud as JSON
//   raymoval_formats convert IN OUT [POINT_LAYOUT]    writes the records of IN to OUT
//   raymoval_formats sequence PATH [OPTION=VALUE...]  the scans of a sequence with their poses
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"

namespace {

using nlohmann::ordered_json;
using raymoval::PointRecords;

ordered_json records_json(const PointRecords& records) {
  ordered_json fields = ordered_json::array();
  for (const raymoval::PointField& field : records.layout.fields) {
    fields.push_back({{"name", field.name},
                      {"type", std::string(1, field.type)},
                      {"size", field.size},
                      {"count", field.count},
                      {"offset", field.offset}});
  }
  constexpr const char* kDigits = "0123456789abcdef";
  std::string rows;
  for (const std::byte byte : records.bytes) {
    rows += kDigits[std::to_integer<unsigned>(byte) >> 4U];
    rows += kDigits[std::to_integer<unsigned>(byte) & 15U];
  }
  return {{"fields", std::move(fields)}, {"row_bytes", records.layout.row_bytes}, {"rows", rows}};
}

void dump(const std::string& path, const raymoval::RecordReading& reading) {
  std::printf("%s\n", records_json(raymoval::read_records(path, reading)).dump().c_str());
}

void convert(const std::string& from, const std::string& to,
             const raymoval::RecordReading& reading) {
  const PointRecords records = raymoval::read_records(from, reading);
  raymoval::PointRecordWriter writer(to);
  writer.start(records.layout);
  writer.add(records);
  writer.finish();
  writer.commit();
}

raymoval::SequenceOptions options_of(const std::map<std::string, std::string>& words) {
  raymoval::SequenceOptions options;
  for (const auto& [name, value] : words) {
    if (name == "poses") options.poses = value;
    if (name == "pose-format") options.pose_format = value;
    if (name == "T-sensor") options.T_sensor = value;
    if (name == "time-offset") options.time_offset_s = raymoval::parse_number<double>(value);
    if (name == "max-gap") options.max_gap_s = raymoval::parse_number<double>(value);
    if (name == "topic") options.topic = value;
    if (name == "pose-topic") options.pose_topic = value;
    if (name == "point-layout") options.point_layout = value;
  }
  return options;
}

/// Records as they are stored, poses and times, and what a user is told.
void sequence(const std::string& path, const std::map<std::string, std::string>& words) {
  const raymoval::Sequence sequence = raymoval::open_sequence(path, options_of(words));
  ordered_json scans = ordered_json::array();
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    const raymoval::Scan scan = sequence.scans->load(i);
    ordered_json pose = ordered_json::array();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        pose.push_back(scan.T_world_sensor.matrix()(row, column));
      }
    }
    ordered_json one = records_json(sequence.records->records(i));
    one["returns"] = scan.size();
    one["name"] = scan.name;
    one["time_s"] = scan.time_s;
    one["pose"] = std::move(pose);
    scans.push_back(std::move(one));
  }
  const ordered_json all = {{"notes", raymoval::opening_lines(sequence)},
                            {"scans", std::move(scans)}};
  std::printf("%s\n", all.dump().c_str());
}

/// @return whether there is such a command with these words
bool run(const std::vector<std::string>& words) {
  const std::string command = words.empty() ? "" : words[0];
  const std::size_t named = command == "dump" || command == "sequence" ? 2 : 3;
  if (words.size() < named) return false;
  raymoval::RecordReading reading;
  if (words.size() > named) reading.point_layout = words[named];
  if (command == "dump") {
    dump(words[1], reading);
  } else if (command == "convert") {
    convert(words[1], words[2], reading);
  } else if (command == "sequence") {
    std::map<std::string, std::string> options;
    for (std::size_t i = 2; i < words.size(); ++i) {
      const std::size_t equals = words[i].find('=');
      options[words[i].substr(0, equals)] = words[i].substr(equals + 1);
    }
    sequence(words[1], options);
  } else {
    return false;
  }
  return true;
}

}  // namespace

int main(int count, char** words) {
  try {
    if (run({words + 1, words + count})) return 0;
    std::fprintf(stderr, "expected: dump FILE, convert IN OUT, like IN OUT or sequence PATH\n");
    return 2;
  } catch (const raymoval::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.exit_code());
  }
}
