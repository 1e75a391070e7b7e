// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/cloud_header.h"

#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/stored_points.h"
#include "datasets/records/number_types.h"

namespace raymoval {
namespace {

/// A line of numbers, and its number for messages.
struct AsciiLine {
  std::string_view text;
  std::size_t number = 0;  ///< In the file, from 1.
  std::vector<std::string_view> words;
  const std::filesystem::path& path;

  [[nodiscard]] std::string where() const {
    return path.string() + ": line " + std::to_string(number);
  }
  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    const std::string_view word = words[column];
    throw DataError(
        where() + ", column " + std::to_string(word.data() - text.data() + 1) + ": '" +
        std::string(word.substr(0, 40)) + "' " + what +
        (word.find(',') == std::string_view::npos
             ? "."
             : "; expected decimal points, not commas. Write the numbers with points."));
  }
};

std::size_t values_a_point(const CloudHeader& header) {
  std::size_t count = 0;
  for (const PointField& field : header.fields) count += static_cast<std::size_t>(field.count);
  return count;
}

/// Largest possible number of points: each value takes a character and a separator, except the
/// last.
std::uint64_t possible_points(const CloudHeader& header, std::string_view body) {
  const std::uint64_t possible =
      (body.size() + 1) / (2 * std::max<std::size_t>(values_a_point(header), 1));
  return std::min(header.points, possible);
}

/// The words between commas and blanks.
std::vector<std::string_view> split_commas(std::string_view text) {
  std::vector<std::string_view> words;
  for (const std::string_view part : split(text, ',')) {
    for (const std::string_view word : split_blanks(part)) words.push_back(word);
  }
  return words;
}

/// Calls `put` with each point's number and line. @throws DataError for a wrong count
template <class Put>
void for_each_point(const CloudHeader& header, std::string_view body,
                    const std::filesystem::path& path, Put&& put) {
  const std::size_t values = values_a_point(header);
  std::size_t done = 0;
  AsciiLine line{{}, header.body_line, {}, path};
  for (std::size_t at = 0; at < body.size(); ++line.number) {
    const std::size_t end = std::min(body.find('\n', at), body.size());
    line.text = body.substr(at, end - at);
    at = end + 1;
    if (line.text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    if (done == header.points && !header.points_end_the_file) break;
    if (done == header.points) {
      throw DataError(line.where() + ": more points than the " + grouped_text(header.points) +
                      " the header announces.");
    }
    line.words = split_blanks(line.text);
    if (line.text.find(',') != std::string_view::npos) {
      auto words = split_commas(line.text);
      if (words.size() == values) line.words = std::move(words);
    }
    if (line.words.size() != values) {
      throw DataError(line.where() + ": " + std::to_string(line.words.size()) +
                      " values; the header announces " + std::to_string(values) + " a point.");
    }
    put(done++, line);
  }
  if (done == header.points) return;
  throw DataError(path.string() + ": the header announces " + grouped_text(header.points) +
                  " points, but the file ends after " + grouped_text(done) +
                  "; it looks truncated." + kRereadRemedy);
}

/// The value of `word` minus `origin`; empty if it is no number.
std::optional<float> parsed_value(std::string_view word, double origin) {
  if (origin == 0.0) {
    if (const auto value = parse_number<float>(word)) return value;
  }
  const auto value = parse_number<double>(word);
  if (!value) return std::nullopt;
  const double near = *value - origin;
  if (std::isfinite(near) && std::abs(near) > std::numeric_limits<float>::max()) {
    return std::nullopt;
  }
  return static_cast<float>(near);
}

/// Parses a number of type `Number`. Whole types also accept 255.0 and 1e3.
template <class Number>
std::optional<Number> typed_value(std::string_view word) {
  if (const auto value = parse_number<Number>(word)) return value;
  if constexpr (std::is_same_v<Number, float>) return parsed_value(word, 0.0);
  if constexpr (std::is_integral_v<Number>) {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    const auto value = parse_number<double>(word);
    if (!value || !(std::abs(*value) <= kExact) || *value != std::floor(*value)) {
      return std::nullopt;
    }
    if (*value < static_cast<double>(std::numeric_limits<Number>::min()) ||
        *value > static_cast<double>(std::numeric_limits<Number>::max())) {
      return std::nullopt;
    }
    return static_cast<Number>(*value);
  }
  return std::nullopt;
}

bool put_value(std::string_view word, const PointField& field, std::byte* to) {
  return with_number_type(field.type, field.size, [&](auto zero) {
    const auto value = typed_value<decltype(zero)>(word);
    if (value) std::memcpy(to, &*value, sizeof *value);
    return value.has_value();
  });
}

void put_row(const CloudHeader& header, const AsciiLine& line, std::byte* row) {
  std::size_t column = 0;
  for (const PointField& field : header.fields) {
    std::byte* to = row + field.offset;
    for (int at = 0; at < field.count; ++at, to += field.size, ++column) {
      if (put_value(line.words[column], field, to) || is_padding(field)) continue;
      const PointField one{field.name, field.type, field.size};
      line.fail(column, "is not a number of the field '" + one.text() + "'");
    }
  }
}

Cloud ascii_cloud(const CloudHeader& header, std::string_view body,
                  const std::filesystem::path& path, const Eigen::Vector3d& origin) {
  std::vector<std::size_t> columns;
  for (const PointField& wanted :
       cloud_fields({header.fields, header.row_bytes()}, path.string())) {
    std::size_t column = 0;
    for (std::size_t i = 0; header.fields[i] != wanted; ++i) {
      column += static_cast<std::size_t>(header.fields[i].count);
    }
    columns.push_back(column);
  }
  Cloud cloud;
  cloud.points.resize(possible_points(header, body));
  if (columns.size() > 3) cloud.intensity.resize(cloud.points.size());
  for_each_point(header, body, path, [&](std::size_t point, const AsciiLine& line) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto value = parsed_value(line.words[columns[c]], origin_of(c, origin));
      if (!value) line.fail(columns[c], "is not a number");
      (c < 3 ? cloud.points[point][static_cast<Eigen::Index>(c)] : cloud.intensity[point]) = *value;
    }
  });
  return cloud;
}

PointRecords ascii_records(const CloudHeader& header, std::string_view body,
                           const std::filesystem::path& path) {
  PointRecords records;
  records.layout.row_bytes = header.row_bytes();
  for (const PointField& field : header.fields) {
    if (!is_padding(field)) records.layout.fields.push_back(field);
  }
  records.bytes.resize(possible_points(header, body) * records.layout.row_bytes);
  for_each_point(header, body, path, [&](std::size_t point, const AsciiLine& line) {
    put_row(header, line, records.row(point));
  });
  records.width = header.points;
  return records;
}

StoredPoints binary_points(const CloudHeader& header, std::string_view body,
                           const std::filesystem::path& path) {
  const std::size_t row = header.row_bytes();
  if (header.points > body.size() / row) {
    throw DataError(path.string() + ": the header announces " + grouped_text(header.points) +
                    " points of " + std::to_string(row) + " bytes, but only " +
                    grouped_text(body.size()) + " bytes follow it; the file looks truncated " +
                    "after point " + grouped_text(body.size() / row) + "." + kRereadRemedy);
  }
  StoredPoints stored{body, {}, header.points, row};
  for (const PointField& field : header.fields) {
    stored.columns.push_back({field, field.offset, row, header.big_endian});
    if (is_padding(field)) stored.columns.back().field.name.clear();
  }
  return stored;
}

/// Decompresses the LZF body of a binary_compressed PCD file after checking its stated sizes.
std::string decompress_lzf_block(std::string_view body, std::uint64_t expected_bytes,
                                 const std::filesystem::path& path) {
  // A back reference of 3 bytes gives at most 264.
  constexpr std::uint64_t kMostGain = 88;
  std::array<std::uint32_t, 2> sizes{};
  if (body.size() >= sizeof sizes) std::memcpy(sizes.data(), body.data(), sizeof sizes);
  const auto [packed, unpacked] = sizes;
  if (body.size() < sizeof sizes || packed > body.size() - sizeof sizes) {
    throw DataError(path.string() + ": " + grouped_text(body.size()) +
                    " bytes follow the header, but its compressed block needs " +
                    grouped_text(std::uint64_t{packed} + sizeof sizes) +
                    "; the file looks truncated." + kRereadRemedy);
  }
  if (unpacked != expected_bytes) {
    throw DataError(path.string() + ": the compressed block announces " + grouped_text(unpacked) +
                    " bytes, but the header's points take " + grouped_text(expected_bytes) +
                    "; the file is damaged." + kRereadRemedy);
  }
  std::string data;
  const bool plausible = unpacked <= std::uint64_t{packed} * kMostGain;
  if (plausible) data.resize(unpacked);
  if (unpacked > 0 && (!plausible || ::lzf_decompress(body.data() + sizeof sizes, packed,
                                                      data.data(), unpacked) != unpacked)) {
    throw DataError(path.string() + ": the compressed block is damaged (LZF decoding fails)." +
                    kRereadRemedy);
  }
  return data;
}

/// The points of a compressed body: all values of a field after one another, padding left out.
StoredPoints compressed_points(const CloudHeader& header, std::string_view body,
                               const std::filesystem::path& path) {
  StoredPoints stored{{}, {}, header.points, header.row_bytes()};
  std::uint64_t bytes = 0;
  for (const PointField& field : header.fields) {
    if (is_padding(field)) continue;
    stored.columns.push_back({field, bytes, field.bytes(), false});
    bytes += field.bytes() * header.points;
  }
  stored.unpacked = std::make_shared<const std::string>(decompress_lzf_block(body, bytes, path));
  stored.bytes = *stored.unpacked;
  return stored;
}

StoredPoints stored_points(const CloudHeader& header, std::string_view body,
                           const std::filesystem::path& path) {
  return header.encoding == CloudEncoding::kCompressed ? compressed_points(header, body, path)
                                                       : binary_points(header, body, path);
}

}  // namespace

Cloud header_cloud(const CloudHeader& header, const CloudBytes& file,
                   const Eigen::Vector3d& origin) {
  const std::string_view body = file.text.substr(header.body_offset);
  if (header.encoding == CloudEncoding::kAscii) {
    return ascii_cloud(header, body, file.path, origin);
  }
  return cloud_of(stored_points(header, body, file.path), origin, file.path.string());
}

PointRecords header_records(const CloudHeader& header, const CloudBytes& file) {
  const std::string_view body = file.text.substr(header.body_offset);
  PointRecords records = header.encoding == CloudEncoding::kAscii
                             ? ascii_records(header, body, file.path)
                             : records_of(stored_points(header, body, file.path));
  records.width = header.width;
  records.height = header.height;
  records.viewpoint = header.viewpoint;
  return records;
}

}  // namespace raymoval
