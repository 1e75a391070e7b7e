// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_header.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

// More than any sensor's record; these guard the arithmetic that follows.
constexpr int kLargestCount = 65536;
constexpr std::size_t kLargestRow = 1 << 20;

/// Lines of a header, one by one, with what is needed to report them.
class HeaderLines {
 public:
  HeaderLines(std::string_view bytes, const std::filesystem::path& path, const char* last_entry)
      : bytes_(bytes), path_(path), last_entry_(last_entry) {}

  /// Words of the next line. @throws DataError at the end of the file
  std::vector<std::string_view> next() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos || end - at_ > 65536) {
      throw DataError(path_.string() + ": the header does not end: no line '" + last_entry_ +
                      "' in it. The file is cut or is no such file.");
    }
    const std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    return split_blanks(line);
  }
  [[nodiscard]] std::size_t offset() const { return at_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw DataError(path_.string() + ": header line " + std::to_string(line_) + ": " + what);
  }
  template <class Number>
  Number number(std::string_view text, Number minimum, Number maximum) const {
    const auto value = parse_number<Number>(text);
    if (!value || *value < minimum || *value > maximum) {
      fail("'" + std::string(text) + "' is not a number that can stand here.");
    }
    return *value;
  }

 private:
  std::string_view bytes_;
  const std::filesystem::path& path_;
  const char* last_entry_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
};

void check_fields(const CloudHeader& header, const std::filesystem::path& path) {
  if (header.row_bytes() > kLargestRow || header.points > kMostCloudPoints) {
    throw DataError(path.string() + ": " + grouped_text(header.points) + " points of " +
                    grouped_text(header.row_bytes()) +
                    " bytes are more than a scan can have; the header is damaged.");
  }
  std::vector<std::string> names;
  for (const CloudField& field : header.fields) names.push_back(field.name);
  for (const char* axis : {"x", "y", "z"}) {
    const auto at = header.find({axis});
    if (at && header.fields[*at].count == 1) continue;
    throw DataError(path.string() + ": has no field '" + axis + "' with one value a point; found " +
                    (names.empty() ? "no field" : join(names)) + ", expected x y z.");
  }
}

/// The entries of a PCD header as words by name.
using Entries = std::map<std::string, std::vector<std::string_view>, std::less<>>;

class PcdHeaderParser {
 public:
  PcdHeaderParser(std::string_view bytes, const std::filesystem::path& path)
      : lines_(bytes, path, "DATA"), path_(path) {}

  CloudHeader parse() {
    read_entries();
    CloudHeader header;
    header.fields = fields();
    header.points = point_count();
    header.encoding = encoding();
    header.body_offset = lines_.offset();
    header.body_line = lines_.line() + 1;
    header.viewpoint = viewpoint();
    check_fields(header, path_);
    return header;
  }

 private:
  void read_entries() {
    static const std::vector<std::string> known = {"VERSION", "FIELDS", "COLUMNS",  "SIZE",
                                                   "TYPE",    "COUNT",  "WIDTH",    "HEIGHT",
                                                   "POINTS",  "DATA",   "VIEWPOINT"};
    do {
      const auto words = lines_.next();
      if (words.empty() || words.front().starts_with('#')) continue;
      std::string name(words.front());
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        lines_.fail("'" + name.substr(0, 40) + "' is no entry of a PCD header." +
                    suggestion(name, known));
      }
      if (name == "COLUMNS") name = "FIELDS";
      if (!entries_.emplace(name, std::vector(words.begin() + 1, words.end())).second) {
        lines_.fail(name + " stands there twice.");
      }
    } while (!entries_.contains("DATA"));
  }

  /// Words of entry `name`; as many as `count` if it is given.
  const std::vector<std::string_view>& entry(const std::string& name, std::size_t count) const {
    const auto at = entries_.find(name);
    if (at == entries_.end()) {
      throw DataError(path_.string() + ": the header has no " + name + " entry.");
    }
    if (at->second.size() != count) {
      throw DataError(path_.string() + ": header entry " + name + " has " +
                      std::to_string(at->second.size()) + " values, expected " +
                      std::to_string(count) + ".");
    }
    return at->second;
  }

  std::vector<CloudField> fields() const {
    const auto names = entries_.find("FIELDS");
    const std::size_t count = names == entries_.end() ? 0 : names->second.size();
    entry("FIELDS", count);
    const auto& sizes = entry("SIZE", count);
    const auto& types = entry("TYPE", count);
    std::vector<CloudField> fields;
    for (std::size_t i = 0; i < count; ++i) {
      CloudField field;
      field.name = names->second[i];
      field.size = lines_.number<int>(sizes[i], 1, 8);
      field.type = types[i].size() == 1 ? types[i].front() : '?';
      if (entries_.contains("COUNT")) {
        field.count = lines_.number<int>(entry("COUNT", count)[i], 1, kLargestCount);
      }
      const bool real = field.type == 'F' && (field.size == 4 || field.size == 8);
      const bool whole =
          (field.type == 'I' || field.type == 'U') && (field.size & (field.size - 1)) == 0;
      if (!real && !whole) {
        throw DataError(path_.string() + ": field '" + field.name + "' is TYPE " +
                        std::string(types[i]) + " SIZE " + std::to_string(field.size) +
                        "; expected F with 4 or 8, I or U with 1, 2, 4 or 8.");
      }
      fields.push_back(field);
    }
    return fields;
  }

  std::uint64_t point_count() const {
    const auto read = [&](const char* name) {
      return lines_.number<std::uint64_t>(entry(name, 1).front(), 0, kMostCloudPoints);
    };
    const std::uint64_t by_size = read("WIDTH") * read("HEIGHT");
    if (!entries_.contains("POINTS")) return by_size;
    if (read("POINTS") != by_size) {
      throw DataError(path_.string() + ": the header contradicts itself: POINTS " +
                      std::to_string(read("POINTS")) +
                      ", but WIDTH x HEIGHT = " + std::to_string(by_size) + ".");
    }
    return by_size;
  }

  CloudEncoding encoding() const {
    const std::string_view name = entry("DATA", 1).front();
    if (name == "ascii") return CloudEncoding::kAscii;
    if (name == "binary") return CloudEncoding::kBinary;
    if (name == "binary_compressed") return CloudEncoding::kCompressed;
    lines_.fail("DATA '" + std::string(name) +
                "' is unknown; expected ascii, binary or binary_compressed.");
  }

  std::optional<Eigen::Matrix<double, 7, 1>> viewpoint() const {
    if (!entries_.contains("VIEWPOINT")) return std::nullopt;
    const auto& words = entry("VIEWPOINT", 7);
    Eigen::Matrix<double, 7, 1> values;
    for (int i = 0; i < 7; ++i) {
      const auto value = parse_number<double>(words[static_cast<std::size_t>(i)]);
      if (!value) {
        throw DataError(path_.string() + ": VIEWPOINT value " + std::to_string(i + 1) + ", '" +
                        std::string(words[static_cast<std::size_t>(i)]) +
                        "', is not a number; expected tx ty tz qw qx qy qz.");
      }
      values[i] = *value;
    }
    return values;
  }

  HeaderLines lines_;
  const std::filesystem::path& path_;
  Entries entries_;
};

CloudField ply_field(const HeaderLines& lines, const std::vector<std::string_view>& words) {
  struct Type {
    std::string_view name, other_name;
    char type;
    int size;
  };
  static constexpr std::array<Type, 8> kTypes = {{{"char", "int8", 'I', 1},
                                                  {"uchar", "uint8", 'U', 1},
                                                  {"short", "int16", 'I', 2},
                                                  {"ushort", "uint16", 'U', 2},
                                                  {"int", "int32", 'I', 4},
                                                  {"uint", "uint32", 'U', 4},
                                                  {"float", "float32", 'F', 4},
                                                  {"double", "float64", 'F', 8}}};
  for (const Type& known : kTypes) {
    if (words.size() != 3 || (words[1] != known.name && words[1] != known.other_name)) continue;
    return {std::string(words[2]), known.type, known.size, 1};
  }
  lines.fail(
      "a vertex property has to be 'property TYPE NAME' with a plain number type (no list).");
}

CloudEncoding ply_encoding(const HeaderLines& lines, const std::vector<std::string_view>& words,
                           bool& big_endian) {
  const std::string_view name = words.size() == 3 ? words[1] : std::string_view();
  big_endian = name == "binary_big_endian";
  if (name == "ascii") return CloudEncoding::kAscii;
  if (name == "binary_little_endian" || big_endian) return CloudEncoding::kBinary;
  lines.fail(
      "expected 'format ascii 1.0', 'format binary_little_endian 1.0' or "
      "'format binary_big_endian 1.0'.");
}

}  // namespace

std::size_t CloudHeader::row_bytes() const {
  std::size_t bytes = 0;
  for (const CloudField& field : fields) bytes += field.bytes();
  return bytes;
}

std::optional<std::size_t> CloudHeader::find(const std::vector<std::string_view>& names) const {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (std::find(names.begin(), names.end(), fields[i].name) != names.end()) return i;
  }
  return std::nullopt;
}

CloudHeader parse_pcd_header(std::string_view bytes, const std::filesystem::path& path) {
  return PcdHeaderParser(bytes, path).parse();
}

CloudHeader parse_ply_header(std::string_view bytes, const std::filesystem::path& path) {
  HeaderLines lines(bytes, path, "end_header");
  const auto magic = lines.next();
  if (magic.size() != 1 || magic.front() != "ply") lines.fail("expected 'ply'.");
  CloudHeader header;
  header.points_end_the_file = false;
  bool format_seen = false;
  int elements = 0;
  for (auto words = lines.next();; words = lines.next()) {
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      header.encoding = ply_encoding(lines, words, header.big_endian);
      format_seen = true;
    } else if (words[0] == "element") {
      const bool vertex = words.size() == 3 && words[1] == "vertex";
      if (vertex != (elements++ == 0)) lines.fail("expected 'element vertex COUNT' once, first.");
      if (vertex) header.points = lines.number<std::uint64_t>(words[2], 0, kMostCloudPoints);
    } else if (words[0] == "property") {
      if (elements == 0) lines.fail("a property before any element.");
      if (elements == 1) header.fields.push_back(ply_field(lines, words));
    } else {
      lines.fail("'" + std::string(words[0].substr(0, 40)) + "' is no entry of a PLY header.");
    }
  }
  if (!format_seen) throw DataError(path.string() + ": the header has no format line.");
  header.body_offset = lines.offset();
  header.body_line = lines.line() + 1;
  check_fields(header, path);
  return header;
}

}  // namespace raymoval
