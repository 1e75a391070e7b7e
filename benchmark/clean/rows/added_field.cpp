// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/added_field.h"

#include <utility>

namespace raymoval {

RecordLayout layout_with_field(const RecordLayout& layout, std::string name, char type, int size) {
  while (layout.find({name}) != nullptr) name = "raymoval_" + name;
  RecordLayout more = layout;
  more.add(std::move(name), type, size);
  return more;
}

}  // namespace raymoval
