// SPDX-License-Identifier: MIT
#include "datasets/clouds/las/las_layout.h"

#include <algorithm>
#include <array>

namespace raymoval {
namespace {

/// Puts together the record of a format.
class LasRecord {
 public:
  explicit LasRecord(int format) {
    const bool old = format < 6;
    old ? add_old_begin() : add_new_begin();
    if (!old || format == 1 || format >= 3) add("gps_time", 'F', 8);
    const auto has = [&](std::initializer_list<int> formats) {
      return std::find(formats.begin(), formats.end(), format) != formats.end();
    };
    if (has({2, 3, 5, 7, 8, 10})) {
      for (const char* colour : {"red", "green", "blue"}) add(colour, 'U', 2);
    }
    if (has({8, 10})) add("nir", 'U', 2);
    if (has({4, 5, 9, 10})) add_wave_packet();
  }
  std::vector<LasField> fields;
  std::size_t bytes = 12;  ///< X, Y and Z.

 private:
  void add(const char* name, char type, int size) {
    fields.push_back({name, type, size, bytes});
    bytes += static_cast<std::size_t>(size);
  }
  void add_bits(const char* name, int bit, int bits) {
    fields.push_back({name, 'U', 1, bytes, bit, bits});
  }
  void add_old_begin() {
    add("intensity", 'U', 2);
    add_bits("return_number", 0, 3);
    add_bits("number_of_returns", 3, 3);
    add_bits("scan_direction_flag", 6, 1);
    add_bits("edge_of_flight_line", 7, 1);
    ++bytes;
    add_bits("classification", 0, 5);
    add_bits("synthetic", 5, 1);
    add_bits("key_point", 6, 1);
    add_bits("withheld", 7, 1);
    ++bytes;
    add("scan_angle_rank", 'I', 1);
    add("user_data", 'U', 1);
    add("point_source_id", 'U', 2);
  }
  void add_new_begin() {
    add("intensity", 'U', 2);
    add_bits("return_number", 0, 4);
    add_bits("number_of_returns", 4, 4);
    ++bytes;
    add_bits("synthetic", 0, 1);
    add_bits("key_point", 1, 1);
    add_bits("withheld", 2, 1);
    add_bits("overlap", 3, 1);
    add_bits("scanner_channel", 4, 2);
    add_bits("scan_direction_flag", 6, 1);
    add_bits("edge_of_flight_line", 7, 1);
    ++bytes;
    add("classification", 'U', 1);
    add("user_data", 'U', 1);
    add("scan_angle", 'I', 2);
    add("point_source_id", 'U', 2);
  }
  void add_wave_packet() {
    add("wavepacket_index", 'U', 1);
    add("wavepacket_offset", 'U', 8);
    add("wavepacket_size", 'U', 4);
    for (const char* name : {"return_point_wave_location", "x_t", "y_t", "z_t"}) add(name, 'F', 4);
  }
};

const LasRecord& record(int format) {
  static const std::vector<LasRecord> records = [] {
    std::vector<LasRecord> all;
    for (int i = 0; i < kLasFormats; ++i) all.emplace_back(i);
    return all;
  }();
  return records.at(static_cast<std::size_t>(format));
}

}  // namespace

const std::vector<LasField>& las_fields(int format) {
  return record(format).fields;
}

std::size_t las_record_bytes(int format) {
  return record(format).bytes;
}

const std::vector<std::string>& las_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"x", "y", "z", "X", "Y", "Z"};
    for (int format = 0; format < kLasFormats; ++format) {
      for (const LasField& field : las_fields(format)) {
        if (std::find(all.begin(), all.end(), field.name) == all.end())
          all.emplace_back(field.name);
      }
    }
    return all;
  }();
  return names;
}

}  // namespace raymoval
