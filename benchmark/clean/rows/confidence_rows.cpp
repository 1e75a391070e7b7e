// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/confidence_rows.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/scan/confidence_store.h"

namespace raymoval {

RecordLayout layout_with_confidence(const RecordLayout& layout) {
  RecordLayout more = layout;
  std::string name = "confidence";
  while (layout.find({name}) != nullptr) name = "raymoval_" + name;
  more.add(name, 'F', 4);
  return more;
}

ScanRows rows_with_confidence(const ScanRows& rows, const RecordLayout& layout,
                              const std::string& steps) {
  const std::size_t size = rows.rows.size();
  ScanRows result{{layout, std::vector<std::byte>(size * layout.row_bytes), size, 1}, rows.world};
  result.rows.las = rows.rows.las;
  const std::size_t bytes = rows.rows.layout.row_bytes;
  for (std::size_t i = 0; i < size; ++i) {
    const float confidence = confidence_of_steps(static_cast<std::uint8_t>(steps[i]));
    std::memcpy(result.rows.row(i), rows.rows.row(i), bytes);
    std::memcpy(result.rows.row(i) + bytes, &confidence, sizeof confidence);
  }
  return result;
}

}  // namespace raymoval
