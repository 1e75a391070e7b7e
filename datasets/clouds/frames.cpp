// SPDX-License-Identifier: MIT
#include "datasets/clouds/frames.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr const char* kRangeForm =
    "expected FIRST:LAST or FIRST:LAST:STRIDE over frame numbers, ends included, any part may be "
    "empty: 2350:2670:2, 100:200, ::2.";

/// Part of a range; empty for an empty text.
std::optional<long> range_part(const std::string& text, std::string_view part, const char* what,
                               long minimum) {
  if (part.empty()) return std::nullopt;
  const auto value = parse_number<long>(part);
  if (!value || *value < minimum) {
    throw UsageError("frame range '" + text + "': " + what + " '" + std::string(part) +
                     "' is not a whole number from " + std::to_string(minimum) + " on; " +
                     kRangeForm);
  }
  return value;
}

/// Takes a run of digits off the front of `text`, without its leading zeros.
std::string_view take_digits(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && is_digit(text[end])) ++end;
  std::string_view digits = text.substr(0, end);
  text.remove_prefix(end);
  while (digits.size() > 1 && digits.front() == '0') digits.remove_prefix(1);
  return digits;
}

}  // namespace

FrameRange parse_frame_range(const std::string& text) {
  const auto parts = split(text, ':');
  if (parts.size() < 2 || parts.size() > 3) {
    const bool number = parse_number<long>(text).value_or(-1) >= 0;
    throw UsageError("frame range '" + text + "': " + kRangeForm +
                     (number ? " A single frame is " + text + ":" + text + "." : ""));
  }
  FrameRange range;
  range.first = range_part(text, parts[0], "first", 0);
  range.last = range_part(text, parts[1], "last", 0);
  if (parts.size() == 3) range.stride = range_part(text, parts[2], "stride", 1).value_or(1);
  if (range.first && range.last && *range.first > *range.last) {
    throw UsageError("frame range '" + text + "' stops before it starts; " + kRangeForm);
  }
  return range;
}

std::string frame_range_text(const FrameRange& range) {
  const auto part = [](const std::optional<long>& value) {
    return value ? std::to_string(*value) : std::string();
  };
  return part(range.first) + ":" + part(range.last) + ":" + std::to_string(range.stride);
}

std::string frame_extent_text(const std::vector<NumberedFile>& files) {
  return counted_text(files.size(), "frame") + " from " + std::to_string(files.front().number) +
         " to " + std::to_string(files.back().number);
}

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const auto left = take_digits(a), right = take_digits(b);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
      continue;
    }
    if (a.front() != b.front()) return a.front() < b.front();
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // 01 and 1: any fixed order will do.
}

std::vector<std::filesystem::path> list_files(const std::filesystem::path& folder,
                                              const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : entries_of(folder)) {
    const std::string name = in_lower_case(path.filename().string());
    if (name.starts_with(".")) continue;
    const bool wanted =
        std::any_of(extensions.begin(), extensions.end(), [&](const std::string& extension) {
          return name.size() > extension.size() && name.ends_with(extension);
        });
    if (wanted) files.push_back(path);
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

std::string content_text(const std::filesystem::path& folder) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> names;
  const std::vector<std::filesystem::path> folders = folders_in(folder);
  for (const std::filesystem::path& path : entries_of(folder)) {
    const bool is_one = std::find(folders.begin(), folders.end(), path) != folders.end();
    names.push_back(path.filename().string() + (is_one ? "/" : ""));
  }
  if (names.empty()) return "nothing";
  const std::size_t more = names.size() - std::min(names.size(), kMost);
  names.resize(std::min(names.size(), kMost));
  return join(names) + (more > 0 ? " and " + grouped_text(more) + " more" : "");
}

std::vector<NumberedFile> list_numbered_files(const std::filesystem::path& folder,
                                              const std::string& extension) {
  std::vector<NumberedFile> files;
  for (const auto& path : list_files(folder, {extension})) {
    const auto number = parse_number<long>(path.stem().string());
    if (!number || *number < 0) {
      throw DataError(path.string() +
                      ": the name is not a frame number; expected names like 000123" + extension +
                      ". Move other files out of this folder.");
    }
    if (!files.empty() && files.back().number == *number) {
      throw DataError(path.string() + ": frame " + std::to_string(*number) + " is already " +
                      files.back().path.filename().string() + "; keep one of the two.");
    }
    files.push_back({*number, path});
  }
  if (files.empty()) {
    throw DataError(folder.string() + ": holds no *" + extension +
                    " file; expected one scan a file, such as 000000" + extension + ".");
  }
  return files;
}

ChosenFrames choose_frames(const std::vector<NumberedFile>& files, const FrameRange& range,
                           const std::string& where) {
  const FrameRange used{range.first.value_or(files.front().number),
                        range.last.value_or(files.back().number), range.stride};
  const std::string asked = where + ": --frames " + frame_range_text(range);
  if (*used.first < files.front().number || *used.last > files.back().number ||
      *used.first > *used.last) {
    throw DataError(asked + " reaches outside the data, which has " + frame_extent_text(files) +
                    ".");
  }
  ChosenFrames chosen{{}, used};
  long expected = *used.first;
  for (const NumberedFile& file : files) {
    if (file.number < *used.first || file.number > *used.last) continue;
    if ((file.number - *used.first) % used.stride != 0) continue;
    if ((range.first || range.last) && file.number != expected) break;
    chosen.files.push_back(file);
    if (file.number > *used.last - used.stride) return chosen;
    expected = file.number + used.stride;
  }
  if (range.first || range.last) {
    throw DataError(asked + ": there is no file for frame " + std::to_string(expected) +
                    "; the folder has " + frame_extent_text(files) +
                    ". Add the file, or choose frames without the gap.");
  }
  return chosen;
}

}  // namespace raymoval
