// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/header_rows.h"

#include "core/error.h"
#include "core/text.h"

namespace raymoval {

StoredPoints binary_points(const CloudHeader& header, std::string_view body,
                           const std::filesystem::path& path) {
  const std::size_t row = header.row_bytes();
  if (header.points > body.size() / row) {
    throw DataError(path.string() + ": the header announces " + grouped_text(header.points) +
                    " points of " + std::to_string(row) + " bytes, but only " +
                    grouped_text(body.size()) + " bytes follow it; the file looks truncated " +
                    "after point " + grouped_text(body.size() / row) +
                    ". Copy it again, or leave it out with --frames.");
  }
  StoredPoints stored{body, {}, header.points, row};
  for (const PointField& field : header.fields) {
    stored.columns.push_back({field, field.offset, row, header.big_endian});
    if (is_padding(field)) stored.columns.back().field.name.clear();
  }
  return stored;
}

}  // namespace raymoval
