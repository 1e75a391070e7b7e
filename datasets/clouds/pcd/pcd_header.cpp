// SPDX-License-Identifier: MIT
#include "datasets/clouds/pcd/pcd_header.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/text.h"

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

}  // namespace

CloudHeader parse_pcd_header(std::string_view bytes, const std::filesystem::path& path) {
  return PcdHeaderParser(bytes, path).parse();
}

}  // namespace raymoval
