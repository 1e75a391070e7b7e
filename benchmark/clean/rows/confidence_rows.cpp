// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/confidence_rows.h"

#include <cstddef>
#include <cstdint>

#include "benchmark/clean/rows/added_field.h"
#include "core/scan/confidence_store.h"

namespace raymoval {

RecordLayout layout_with_confidence(const RecordLayout& layout) {
  return layout_with_field(layout, "confidence", 'F', sizeof(float));
}

ScanRows rows_with_confidence(const ScanRows& rows, const RecordLayout& layout,
                              const std::string& steps) {
  return rows_with_field(rows, layout, [&](std::size_t i) {
    return confidence_of_steps(static_cast<std::uint8_t>(steps[i]));
  });
}

}  // namespace raymoval
