// SPDX-License-Identifier: MIT
#include "core/name.h"

#include <string_view>

#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {

std::string name_problem(const std::string& name) {
  constexpr std::size_t kMostBytes = 200;  // Of the 255 that a file's name may have.
  if (name.empty()) return "is empty";
  if (name.size() > kMostBytes) return "has " + grouped_text(name.size()) + " bytes";
  if (printable_text(name) != name) return "has a character that cannot be shown";
  if (name.find_first_of("/\\") != std::string::npos) return "has a slash";
  if (name.front() == ' ' || name.back() == ' ') return "begins or ends with a blank";
  if (std::string_view(".-=+@").find(name.front()) != std::string_view::npos) {
    return std::string("begins with '") + name.front() + "'";
  }
  return "";
}

}  // namespace raymoval
