// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval::test {

inline void write_records(const std::filesystem::path& path, const PointRecords& records) {
  PointRecordWriter writer(path);
  writer.start(records.layout);
  writer.add(records);
  writer.finish();
  writer.commit();
}

/// All values of a field, as doubles.
inline std::vector<double> column(const PointRecords& records, const std::string& name) {
  const PointField* field = records.layout.find({name});
  if (field == nullptr) return {};
  std::vector<double> values;
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (int at = 0; at < field->count; ++at) values.push_back(records.value(i, *field, at));
  }
  return values;
}

inline std::vector<std::string> field_texts(const RecordLayout& layout) {
  std::vector<std::string> texts;
  for (const PointField& field : layout.fields) texts.push_back(field.text());
  return texts;
}

/// Whether field `name` has the same bytes in both, point by point.
inline bool same_bytes(const PointRecords& a, const PointRecords& b, const std::string& name,
                       const std::string& name_in_b) {
  const PointField* in_a = a.layout.find({name});
  const PointField* in_b = b.layout.find({name_in_b});
  if (in_a == nullptr || in_b == nullptr || in_a->bytes() != in_b->bytes()) return false;
  if (in_a->type != in_b->type || a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::memcmp(a.row(i) + in_a->offset, b.row(i) + in_b->offset, in_a->bytes()) != 0) {
      return false;
    }
  }
  return true;
}

/// Points of a made-up layout: x y z somewhere among fields of any types and counts, with bytes
/// that mean nothing between some of them, and any bits in all but the coordinates.
inline PointRecords random_records(std::mt19937& random, bool with_gaps = true) {
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random()) % limit; };
  PointRecords records;
  const std::vector<std::pair<char, int>> types = {{'F', 4}, {'F', 8}, {'I', 1}, {'I', 2},
                                                   {'I', 4}, {'I', 8}, {'U', 1}, {'U', 2},
                                                   {'U', 4}, {'U', 8}};
  std::vector<std::string> names = {"x", "y", "z", "ring", "t", "a b", "normal", "intensity"};
  std::shuffle(names.begin(), names.end(), random);
  for (const std::string& name : names) {
    if (with_gaps && below(4) == 0) records.layout.row_bytes += 1 + below(5);
    const bool axis = name.size() == 1 && name != "t";
    if (!axis && below(4) == 0) continue;
    const auto [type, size] = axis ? std::pair('F', 8) : types[below(types.size())];
    records.layout.add(name, type, size, axis || below(3) > 0 ? 1 : static_cast<int>(1 + below(4)));
  }
  if (with_gaps && below(3) == 0) records.layout.row_bytes += 3;
  records.width = below(20);
  records.bytes.resize(records.width * records.layout.row_bytes);
  for (std::byte& byte : records.bytes) byte = static_cast<std::byte>(random());
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (const char* axis : {"x", "y", "z"}) {
      records.set_value(i, *records.layout.find({axis}), static_cast<double>(below(4000)) * 0.25);
    }
  }
  return records;
}

/// Truncates `good` at every `step`-th byte, and also changes that byte, writes the result to the
/// file `name`, and passes its path to `read`. `read` may throw a DataError that names the file
/// (but not within a CHECK, which catches it).
inline void read_cut_and_flipped(const std::string& name, const std::string& good, std::size_t step,
                                 const std::function<void(const std::filesystem::path&)>& read) {
  const TemporaryFolder folder;
  std::mt19937 random(5);
  for (std::size_t i = 0; i < good.size(); i += step) {
    std::string flipped = good;
    flipped[i] = static_cast<char>(random());
    for (const std::string& damaged : {good.substr(0, i), flipped}) {
      try {
        read(folder.write(name, damaged));
      } catch (const DataError& error) {
        CHECK_THAT(error.what(), Catch::Contains(name));
      }
    }
  }
}

}  // namespace raymoval::test
