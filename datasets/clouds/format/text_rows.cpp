// SPDX-License-Identifier: MIT
#include "datasets/clouds/format/text_rows.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "datasets/records/number_types.h"

namespace raymoval {
namespace {

template <class Number>
void put_number(const std::byte* from, std::string& text) {
  Number value{};
  std::memcpy(&value, from, sizeof value);
  if constexpr (std::is_floating_point_v<Number>) {
    if (std::isnan(value)) {
      text += "nan";
      return;
    }
  }
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

}  // namespace

std::string text_rows(const PointRecords& records, const std::vector<PointField>& fields) {
  std::string text;
  for (std::size_t i = 0; i < records.size(); ++i) {
    for (const PointField& field : fields) {
      for (int at = 0; at < field.count; ++at) {
        if (!text.empty() && text.back() != '\n') text += ' ';
        const std::byte* place =
            records.row(i) + field.offset +
            static_cast<std::size_t>(at) * static_cast<std::size_t>(field.size);
        with_number_type(field.type, field.size,
                         [&](auto zero) { put_number<decltype(zero)>(place, text); });
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace raymoval
