// SPDX-License-Identifier: MIT
#include <array>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/field_names.h"

namespace raymoval {
namespace {

struct PlyType {
  std::string_view name, other_name;
  char type;
  int size;
};

const PlyType* find_type(std::string_view name) {
  static constexpr std::array<PlyType, 8> kTypes = {{{"char", "int8", 'I', 1},
                                                     {"uchar", "uint8", 'U', 1},
                                                     {"short", "int16", 'I', 2},
                                                     {"ushort", "uint16", 'U', 2},
                                                     {"int", "int32", 'I', 4},
                                                     {"uint", "uint32", 'U', 4},
                                                     {"float", "float32", 'F', 4},
                                                     {"double", "float64", 'F', 8}}};
  for (const PlyType& known : kTypes) {
    if (name == known.name || name == known.other_name) return &known;
  }
  return nullptr;
}

class PlyHeaderParser {
 public:
  PlyHeaderParser(std::string_view bytes, const std::filesystem::path& path)
      : path_(path), lines_(bytes, path, "end_header") {}

  CloudHeader parse() {
    const auto magic = lines_.next();
    if (magic.size() != 1 || magic.front() != "ply") lines_.fail("expected 'ply'.");
    header_.points_end_the_file = false;
    for (auto words = lines_.next(); words.empty() || words[0] != "end_header";
         words = lines_.next()) {
      if (!words.empty()) read_line(words);
    }
    if (!format_seen_) throw DataError(path_.string() + ": the header has no format line.");
    if (where_ != Where::kVertices && where_ != Where::kBehind) {
      throw DataError(path_.string() +
                      ": has no points: expected 'element vertex COUNT' in the header. If it is "
                      "something else than scans, leave it out.");
    }
    header_.body_offset = lines_.offset();
    header_.body_line = lines_.line() + 1;
    header_.width = header_.points;
    check_fields(header_, path_);
    return std::move(header_);
  }

 private:
  enum class Where { kNoElement, kBefore, kVertices, kBehind };

  void read_line(const std::vector<std::string_view>& words) {
    if (words[0] == "comment" || words[0] == "obj_info") return;
    if (words[0] == "format") return read_format(words);
    if (words[0] == "element") return read_element(words);
    if (words[0] == "property") return read_property(words);
    lines_.fail("'" + std::string(words[0].substr(0, 40)) + "' is not an entry of a PLY header.");
  }

  void read_format(const std::vector<std::string_view>& words) {
    const std::string_view name = words.size() == 3 ? words[1] : std::string_view();
    header_.big_endian = name == "binary_big_endian";
    header_.encoding = name == "ascii" ? CloudEncoding::kAscii : CloudEncoding::kBinary;
    format_seen_ = true;
    if (name == "ascii" || name == "binary_little_endian" || header_.big_endian) return;
    lines_.fail(
        "expected 'format ascii 1.0', 'format binary_little_endian 1.0' or "
        "'format binary_big_endian 1.0'.");
  }

  void read_element(const std::vector<std::string_view>& words) {
    const bool vertices_seen = where_ == Where::kVertices || where_ == Where::kBehind;
    const bool vertex = words.size() > 1 && words[1] == "vertex";
    if (words.size() != 3 || (vertex && vertices_seen)) {
      lines_.fail("expected 'element NAME COUNT', and the name 'vertex' once.");
    }
    const auto count = lines_.number<std::uint64_t>(words[2], 0, kMostCloudPoints);
    if (vertex) {
      header_.points = count;
      where_ = Where::kVertices;
    } else if (vertices_seen || count == 0) {
      where_ = vertices_seen ? Where::kBehind : Where::kBefore;
    } else {
      lines_.fail("the element '" + std::string(words[1].substr(0, 40)) +
                  "' is before the vertices. CloudCompare saves the file with the vertices first.");
    }
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (where_ == Where::kNoElement) lines_.fail("a property before any element.");
    if (where_ != Where::kVertices) return;
    const PlyType* type = words.size() == 3 ? find_type(words[1]) : nullptr;
    if (type == nullptr) {
      lines_.fail(
          "a vertex property has to be 'property TYPE NAME' with a plain number type (no list).");
    }
    header_.add(std::string(words[2]), type->type, type->size, 1);
  }

  const std::filesystem::path& path_;
  HeaderLines lines_;
  CloudHeader header_;
  Where where_ = Where::kNoElement;
  bool format_seen_ = false;
};

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
    // Blanks in a comment reserve room for digits, so that the head always has the same length.
    return "ply\nformat binary_little_endian 1.0\ncomment Written by raymoval" +
           std::string(kCountDigits - count.size(), ' ') + "\nelement vertex " + count + "\n" +
           properties_ + "end_header\n";
  }

  std::string rows(const PointRecords& more) override {
    if (packed_) return RecordEncoder::rows(more);
    std::string bytes;
    bytes.reserve(more.size() * packed_bytes_);
    for (std::size_t i = 0; i < more.size(); ++i) {
      for (const PointField& field : more.layout.fields) put(more, i, field, bytes);
    }
    return bytes;
  }

 private:
  static void put(const PointRecords& rows, std::size_t row, const PointField& field,
                  std::string& bytes) {
    if (!is_wide(field)) {
      bytes.append(reinterpret_cast<const char*>(rows.row(row) + field.offset), field.bytes());
      return;
    }
    for (int at = 0; at < field.count; ++at) {
      const double value = rows.value(row, field, at);
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }

  std::string properties_;
  bool packed_ = true;  ///< Whether rows are copied to the file unchanged.
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

CloudHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& path) {
  return PlyHeaderParser(bytes, path).parse();
}

CloudFormat ply_format() {
  CloudFormat format = header_format<PlyEncoder, parse_ply_header>(".ply");
  format.lost = lost_in_ply;
  return format;
}

}  // namespace raymoval
