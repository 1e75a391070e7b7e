// SPDX-License-Identifier: MIT
#include "datasets/clouds/ply/ply_file.h"

#include <algorithm>

#include "core/error.h"
#include "datasets/clouds/format/ascii_rows.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/format/header_rows.h"
#include "datasets/clouds/format/text_rows.h"
#include "datasets/clouds/ply/ply_header.h"

namespace raymoval {
namespace {

Cloud read_ply_cloud(const CloudBytes& file, const Eigen::Vector3d& origin) {
  const CloudHeader header = parse_ply_header(file.text, file.path);
  const std::string_view body = file.text.substr(header.body_offset);
  if (header.encoding == CloudEncoding::kAscii) {
    return ascii_cloud(header, body, file.path, origin);
  }
  return cloud_of(binary_points(header, body, file.path), origin, file.path.string());
}

PointRecords read_ply_records(const CloudBytes& file) {
  const CloudHeader header = parse_ply_header(file.text, file.path);
  const std::string_view body = file.text.substr(header.body_offset);
  const bool text = header.encoding == CloudEncoding::kAscii;
  PointRecords records = text ? ascii_records(header, body, file.path)
                              : records_of(binary_points(header, body, file.path));
  records.form.text = text;
  records.form.big_endian = header.big_endian;
  return records;
}

/// Whether PLY has no type for the values of `field`.
bool is_wide(const PointField& field) {
  return field.type != 'F' && field.size == 8;
}

const char* type_name(const PointField& field) {
  if (field.type == 'F') return field.size == 4 ? "float" : "double";
  if (is_wide(field)) return "double";
  const bool is_signed = field.type == 'I';
  if (field.size == 1) return is_signed ? "char" : "uchar";
  if (field.size == 2) return is_signed ? "short" : "ushort";
  return is_signed ? "int" : "uint";
}

class PlyEncoder : public RecordEncoder {
 public:
  explicit PlyEncoder(const StoredForm& form) : form_(form) {}

  void start(const PointRecords& first) override {
    const std::vector<std::string> names = fitting_names(value_names(first.layout), {});
    std::size_t value = 0;
    for (const PointField& field : first.layout.fields) {
      for (int at = 0; at < field.count; ++at, ++value) {
        properties_ += std::string("property ") + type_name(field) + " " + names[value] + "\n";
      }
      packed_ = packed_ && !is_wide(field) && field.offset == packed_bytes_;
      packed_bytes_ += field.bytes();
    }
    packed_ = packed_ && packed_bytes_ == first.layout.row_bytes;
  }

  std::string head(std::uint64_t points) const override {
    constexpr std::size_t kCountDigits = 10;
    const std::string count = std::to_string(points);
    // Blanks in a comment give room for the digits, so that the head always has the same length.
    const char* format = form_.text         ? "ascii"
                         : form_.big_endian ? "binary_big_endian"
                                            : "binary_little_endian";
    return std::string("ply\nformat ") + format + " 1.0\ncomment Written by raymoval" +
           std::string(kCountDigits - count.size(), ' ') + "\nelement vertex " + count + "\n" +
           properties_ + "end_header\n";
  }

  std::string rows(const PointRecords& more) override {
    if (form_.text) return text_rows(more, more.layout.fields);
    if (packed_ && !form_.big_endian) {
      return {reinterpret_cast<const char*>(more.bytes.data()), more.bytes.size()};
    }
    std::string bytes;
    bytes.reserve(more.size() * packed_bytes_);
    for (std::size_t i = 0; i < more.size(); ++i) {
      for (const PointField& field : more.layout.fields) put(more, i, field, bytes);
    }
    return bytes;
  }

 private:
  void put(const PointRecords& rows, std::size_t row, const PointField& field,
           std::string& bytes) const {
    for (int at = 0; at < field.count; ++at) {
      const double value = is_wide(field) ? rows.value(row, field, at) : 0.0;
      const auto size = static_cast<std::size_t>(is_wide(field) ? 8 : field.size);
      const std::size_t place = field.offset + static_cast<std::size_t>(at * field.size);
      const void* from = is_wide(field) ? static_cast<const void*>(&value) : rows.row(row) + place;
      bytes.append(static_cast<const char*>(from), size);
      if (form_.big_endian)
        std::reverse(bytes.end() - static_cast<std::ptrdiff_t>(size), bytes.end());
    }
  }

  StoredForm form_;
  std::string properties_;
  bool packed_ = true;  ///< Whether the rows are the file's as they are.
  std::size_t packed_bytes_ = 0;
};

std::vector<std::string> lost_in_ply(const RecordLayout& layout) {
  std::vector<std::string> sentences;
  for (const PointField& field : layout.fields) {
    if (!is_wide(field)) continue;
    sentences.push_back("The field '" + field.name + "' is " + PointField{field}.text() +
                        ", which PLY does not have: it is written as double, and numbers beyond "
                        "2^53 (9,007,199,254,740,992) are rounded.");
  }
  const auto split = split_sentences(layout);
  sentences.insert(sentences.end(), split.begin(), split.end());
  const std::vector<std::string> wanted = value_names(layout);
  const auto renamed = renamed_sentences(wanted, fitting_names(wanted, {}));
  sentences.insert(sentences.end(), renamed.begin(), renamed.end());
  return sentences;
}

}  // namespace

CloudFormat ply_format() {
  const auto encoder = [](const std::filesystem::path&,
                          const RecordWriting& writing) -> std::unique_ptr<RecordEncoder> {
    return std::make_unique<PlyEncoder>(writing.form);
  };
  return {".ply", read_ply_cloud, read_ply_records, encoder, lost_in_ply};
}

}  // namespace raymoval
