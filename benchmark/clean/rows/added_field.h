// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "benchmark/clean/rows/map_rows.h"

namespace raymoval {

/// `layout` with a field behind it. It is called `name`, or `raymoval_<name>` if there is a field
/// of that name, which stays as it is.
/// @param type,size as those of RecordLayout::add
RecordLayout layout_with_field(const RecordLayout& layout, std::string name, char type, int size);

/// Rows of such a layout: `rows`, each with the bytes of `value_of(row)` behind it.
/// @param layout of `layout_with_field`, whose size is that of a value
template <class ValueOf>
ScanRows rows_with_field(const ScanRows& rows, const RecordLayout& layout, ValueOf value_of) {
  const std::size_t size = rows.rows.size();
  ScanRows result{{layout, std::vector<std::byte>(size * layout.row_bytes), size, 1}, rows.world};
  result.rows.las = rows.rows.las;
  const std::size_t bytes = rows.rows.layout.row_bytes;
  for (std::size_t i = 0; i < size; ++i) {
    const auto value = value_of(i);
    std::memcpy(result.rows.row(i), rows.rows.row(i), bytes);
    std::memcpy(result.rows.row(i) + bytes, &value, sizeof value);
  }
  return result;
}

}  // namespace raymoval
