// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <map>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/field_names.h"

// PCL's readers are not used. They trust counts in a header (a damaged file ends the program), read
// garbage in ASCII files as zero, and report on the console. The library also loads VTK, which
// takes longer to start than this program. PCL compresses with LZF.

namespace raymoval {
namespace {

/// The entries of a PCD header as words by name.
using Entries = std::map<std::string, std::vector<std::string_view>, std::less<>>;

class PcdHeaderParser {
 public:
  PcdHeaderParser(std::string_view bytes, const std::filesystem::path& path)
      : lines_(bytes, path, "DATA"), path_(path) {}

  CloudHeader parse() {
    read_entries();
    CloudHeader header;
    read_fields(header);
    read_counts(header);
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
        lines_.fail("'" + name.substr(0, 40) + "' is not an entry of a PCD header." +
                    suggestion(name, known));
      }
      if (name == "COLUMNS") name = "FIELDS";
      if (!entries_.emplace(name, std::vector(words.begin() + 1, words.end())).second) {
        lines_.fail(name + " occurs twice.");
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

  void read_fields(CloudHeader& header) const {
    const auto names = entries_.find("FIELDS");
    const std::size_t count = names == entries_.end() ? 0 : names->second.size();
    entry("FIELDS", count);
    const auto& sizes = entry("SIZE", count);
    const auto& types = entry("TYPE", count);
    for (std::size_t i = 0; i < count; ++i) {
      PointField field;
      field.name = names->second[i];
      field.size = lines_.number<int>(sizes[i], 1, 8);
      field.type = types[i].size() == 1 ? static_cast<char>(std::toupper(types[i].front())) : '?';
      if (entries_.contains("COUNT")) {
        field.count = lines_.number<int>(entry("COUNT", count)[i], 0, kLargestCount);
      }
      if (field.count == 0) continue;  // Padding of no bytes, as Ouster's driver writes it.
      const bool real = field.type == 'F' && (field.size == 4 || field.size == 8);
      const bool whole =
          (field.type == 'I' || field.type == 'U') && (field.size & (field.size - 1)) == 0;
      if (!real && !whole) {
        throw DataError(path_.string() + ": field '" + field.name + "' is TYPE " +
                        std::string(types[i]) + " SIZE " + std::to_string(field.size) +
                        "; expected F with 4 or 8, I or U with 1, 2, 4 or 8.");
      }
      header.add(field.name, field.type, field.size, field.count);
    }
  }

  void read_counts(CloudHeader& header) const {
    const auto read = [&](const char* name) {
      return lines_.number<std::uint64_t>(entry(name, 1).front(), 0, kMostCloudPoints);
    };
    header.width = read("WIDTH");
    header.height = read("HEIGHT");
    header.points = header.width * header.height;
    if (entries_.contains("POINTS") && read("POINTS") != header.points) {
      throw DataError(path_.string() + ": the header contradicts itself: POINTS " +
                      std::to_string(read("POINTS")) +
                      ", but WIDTH x HEIGHT = " + std::to_string(header.points) + ".");
    }
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

/// Digits of the largest possible count in a head.
constexpr std::size_t kMostDigits = 10;

NameRules pcd_names() {
  NameRules rules;
  rules.taken = {"_"};  // Padding.
  return rules;
}

/// A field, or the padding between two fields.
struct HeadField {
  std::string name, type;
  std::size_t size = 1, count = 1;
};

/// The numbers of the fields in the order of their places.
std::vector<std::size_t> by_place(const RecordLayout& layout) {
  std::vector<std::size_t> order(layout.fields.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return layout.fields[a].offset < layout.fields[b].offset;
  });
  return order;
}

/// In order of their places, with padding between them.
std::vector<HeadField> head_fields(const RecordLayout& layout) {
  const std::vector<std::string> names = fitting_names(names_of(layout), pcd_names());
  std::vector<HeadField> fields;
  std::size_t at = 0;
  const auto fill = [&](std::size_t end) {
    // Readers, including `read_cloud`, may refuse more than 65,536 values per field.
    for (std::size_t bytes = 0; at < end; at += bytes) {
      bytes = std::min<std::size_t>(end - at, 65536);
      fields.push_back({"_", "U", 1, bytes});
    }
  };
  for (const std::size_t i : by_place(layout)) {
    const PointField& field = layout.fields[i];
    fill(field.offset);
    fields.push_back({names[i], std::string(1, field.type), static_cast<std::size_t>(field.size),
                      static_cast<std::size_t>(field.count)});
    at = field.offset + field.bytes();
  }
  fill(layout.row_bytes);
  return fields;
}

std::string field_lines(const RecordLayout& layout) {
  std::string names = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const HeadField& field : head_fields(layout)) {
    names += " " + field.name;
    sizes += " " + std::to_string(field.size);
    types += " " + field.type;
    counts += " " + std::to_string(field.count);
  }
  return names + "\n" + sizes + "\n" + types + "\n" + counts + "\n";
}

std::string viewpoint_text(const Eigen::Matrix<double, 7, 1>& viewpoint) {
  std::string text;
  for (const double value : viewpoint) text += " " + number_text(value);
  return text;
}

class PcdEncoder : public RecordEncoder {
 public:
  void start(const PointRecords& first) override {
    fields_ = field_lines(first.layout);
    if (first.viewpoint) viewpoint_ = viewpoint_text(*first.viewpoint);
    room_ = viewpoint_.size() + 3 * kMostDigits;
  }

  std::string head(std::uint64_t points) const override {
    const std::string width = std::to_string(shape_.of(points).first);
    const std::string height = std::to_string(shape_.of(points).second);
    const std::string count = std::to_string(points);
    const std::size_t used = viewpoint_.size() + width.size() + height.size() + count.size();
    // Blanks in a comment reserve room for digits, so that the head always has the same length.
    return "# .PCD v0.7 - Point Cloud Data file format\n# Written by raymoval" +
           std::string(room_ - std::min(room_, used), ' ') + "\nVERSION 0.7\n" + fields_ +
           "WIDTH " + width + "\nHEIGHT " + height + "\nVIEWPOINT" + viewpoint_ + "\nPOINTS " +
           count + "\nDATA binary\n";
  }

  std::string rows(const PointRecords& more) override {
    shape_.add(more);
    if (more.size() > 0 && more.viewpoint && viewpoint_text(*more.viewpoint) != viewpoint_) {
      viewpoint_ = kNone;
    }
    return RecordEncoder::rows(more);
  }

 private:
  static constexpr const char* kNone = " 0 0 0 1 0 0 0";
  std::string fields_;
  std::string viewpoint_ = kNone;  ///< Never longer than the first one.
  std::size_t room_ = 0;
  WrittenShape shape_;
};

RecordLayout read_pcd_layout(const std::filesystem::path& path, const RecordReading&) {
  constexpr std::size_t kUsualHead = 4096;
  std::string text = read_piece(path, 0, kUsualHead);
  auto header = if_whole([&] { return parse_pcd_header(text, path); });
  if (!header) {
    text = read_text(path);
    header = parse_pcd_header(text, path);
  }
  RecordLayout layout;
  layout.row_bytes = header->row_bytes();
  for (const PointField& field : header->fields) {
    if (!is_padding(field)) layout.fields.push_back(field);
  }
  return layout;
}

std::vector<std::string> lost_in_pcd(const RecordLayout& layout) {
  const std::vector<std::string> wanted = names_of(layout);
  return renamed_sentences(wanted, fitting_names(wanted, pcd_names()));
}

}  // namespace

CloudHeader parse_pcd_header(std::string_view bytes, const std::filesystem::path& path) {
  return PcdHeaderParser(bytes, path).parse();
}

CloudFormat pcd_format() {
  CloudFormat format = header_format<PcdEncoder, parse_pcd_header>(".pcd");
  format.lost = lost_in_pcd;
  format.read_layout = read_pcd_layout;
  return format;
}

}  // namespace raymoval
