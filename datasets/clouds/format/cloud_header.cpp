// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/cloud_header.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace raymoval {

std::size_t CloudHeader::row_bytes() const {
  return fields.empty() ? 0 : fields.back().offset + fields.back().bytes();
}

std::optional<std::size_t> CloudHeader::find(const std::vector<std::string_view>& names) const {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (std::find(names.begin(), names.end(), fields[i].name) != names.end()) return i;
  }
  return std::nullopt;
}

void CloudHeader::add(std::string name, char type, int size, int count) {
  fields.push_back({std::move(name), type, size, count, row_bytes()});
}

void check_fields(const CloudHeader& header, const std::filesystem::path& path) {
  if (header.row_bytes() > kLargestRow || header.points > kMostCloudPoints) {
    throw DataError(path.string() + ": " + grouped_text(header.points) + " points of " +
                    grouped_text(header.row_bytes()) +
                    " bytes are more than a scan can have; the header is damaged.");
  }
  (void)position_fields({header.fields, header.row_bytes()}, path.string());
}

std::vector<std::string_view> HeaderLines::next() {
  const std::size_t end = bytes_.find('\n', at_);
  if (end == std::string_view::npos || end - at_ > 65536) {
    throw DataError(path_.string() + ": the header does not end: no line '" + last_entry_ +
                    "' in it. The file is truncated or has another format." + kRereadRemedy);
  }
  const std::string_view line = bytes_.substr(at_, end - at_);
  at_ = end + 1;
  ++line_;
  return split_blanks(line);
}

void HeaderLines::fail(const std::string& what) const {
  throw DataError(path_.string() + ": header line " + std::to_string(line_) + ": " + what);
}

}  // namespace raymoval
