// SPDX-License-Identifier: MIT
#include "core/files/part_name.h"

#include <algorithm>
#include <random>
#include <string>

namespace raymoval {
namespace {

constexpr std::string_view kMark = ".raymoval-";
constexpr std::string_view kEnd = ".part";
constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kRandomDigits = 16;
constexpr std::size_t kTail = kMark.size() + kRandomDigits + kEnd.size();

}  // namespace

std::filesystem::path new_part_name(const std::filesystem::path& path) {
  std::random_device random;  // From the system: not from time or process number.
  std::string name = (path.has_filename() ? path : path.parent_path()).string();
  name += kMark;
  for (std::size_t i = 0; i < kRandomDigits; ++i) name += kDigits[random() & 15U];
  name += kEnd;
  return name;
}

std::filesystem::path name_of_part(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (name.size() <= kTail) return {};
  const std::string_view tail = std::string_view(name).substr(name.size() - kTail);
  if (!tail.starts_with(kMark) || !tail.ends_with(kEnd)) return {};
  const std::string_view digits = tail.substr(kMark.size(), kRandomDigits);
  if (digits.find_first_not_of(kDigits) != std::string_view::npos) return {};
  return name.substr(0, name.size() - kTail);
}

bool is_part_name(const std::filesystem::path& path) {
  return !name_of_part(path).empty();
}

}  // namespace raymoval
