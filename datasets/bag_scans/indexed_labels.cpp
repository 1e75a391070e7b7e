// SPDX-License-Identifier: MIT
#include "datasets/bag_scans/indexed_labels.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/file_source.h"
#include "datasets/trajectories/stamps.h"

namespace raymoval {
namespace {

constexpr std::uint32_t kUnlabelled = 0, kStatic = 9, kMoving = 251;

/// A labelled scan: where its line is, and which of its points move.
struct Line {
  std::size_t number = 0;  ///< From 1.
  std::vector<std::uint32_t> moving;
};

std::string_view without_blanks(std::string_view text) {
  const auto pieces = split_blanks(text);
  return pieces.size() == 1 ? pieces[0] : std::string_view{};
}

/// @param place "indices.csv: line 3"
std::pair<Nanoseconds, Line> parse_line(std::string_view text, std::size_t number,
                                        const std::string& place) {
  std::vector<std::string_view> fields = split(text, ',');
  if (fields.size() > 1 && split_blanks(fields.back()).empty()) fields.pop_back();
  const auto stamp = parse_stamp(without_blanks(fields[0]), TimeUnit::kNanoseconds);
  if (!stamp) {
    throw DataError(place + ": '" + std::string(fields[0].substr(0, 40)) +
                    "' is not a time; expected the time of a scan in nanoseconds, then the numbers "
                    "of its points that move, between commas.");
  }
  Line line{number, {}};
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const auto point = parse_number<std::uint32_t>(without_blanks(fields[i]));
    if (!point) {
      throw DataError(place + ", field " + std::to_string(i + 1) + ": '" +
                      std::string(fields[i].substr(0, 40)) +
                      "' is not the number of a point; expected a whole number from 0.");
    }
    line.moving.push_back(*point);
  }
  return {*stamp, std::move(line)};
}

std::map<Nanoseconds, Line> read_lines(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  std::map<Nanoseconds, Line> lines;
  std::size_t number = 0;
  for (const std::string_view row : split(text, '\n')) {
    ++number;
    if (split_blanks(row).empty()) continue;
    const std::string place = file.string() + ": line " + std::to_string(number);
    auto [stamp, line] = parse_line(row, number, place);
    const auto [found, is_new] = lines.emplace(stamp, std::move(line));
    if (is_new) continue;
    throw DataError(place + ": has the time of line " + std::to_string(found->second.number) +
                    " again; expected one line a scan. Take one of them out.");
  }
  return lines;
}

class IndexedLabelSource : public LabelSource {
 public:
  IndexedLabelSource(std::filesystem::path file, std::map<std::size_t, Line> lines)
      : file_(std::move(file)), lines_(std::move(lines)) {}

  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    const auto line = lines_.find(scan.index);
    if (line == lines_.end()) return std::vector<std::uint32_t>(scan.size(), kUnlabelled);
    std::vector<std::uint32_t> stored(scan.stored_point_count, kStatic);
    for (const std::uint32_t point : line->second.moving) {
      if (point < stored.size()) {
        stored[point] = kMoving;
        continue;
      }
      throw DataError(file_.string() + ": line " + std::to_string(line->second.number) +
                      ": point " + grouped_text(point) + " of a scan of " +
                      grouped_text(stored.size()) +
                      " points; expected numbers from 0. The file belongs to another recording, or "
                      "to clouds that were thinned since.");
    }
    return of_kept_points(scan, std::move(stored));
  }

 private:
  std::filesystem::path file_;
  std::map<std::size_t, Line> lines_;  ///< By scan.
};

}  // namespace

IndexedLabels read_indexed_labels(const std::filesystem::path& file,
                                  const std::vector<Nanoseconds>& stamps) {
  std::map<Nanoseconds, Line> lines = read_lines(file);
  const std::size_t all = lines.size();
  std::map<std::size_t, Line> of_scan;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const auto line = lines.find(stamps[i]);
    if (line == lines.end()) continue;
    of_scan.emplace(i, std::move(line->second));
    lines.erase(line);
  }
  const std::string name = file.filename().string();
  IndexedLabels found;
  if (of_scan.empty()) {
    found.note = "none of the " + counted_text(all, "line") + " of " + name +
                 " has the time of one of the " + counted_text(stamps.size(), "scan") +
                 ", so there are no labels: the lines are of other scans than these, or of another "
                 "recording.";
    return found;
  }
  found.note = grouped_text(of_scan.size()) + " of " + counted_text(stamps.size(), "scan") +
               " are labelled (" + name + "); the others are not scored.";
  if (!lines.empty()) {
    found.note += " " + counted_text(lines.size(), "line") +
                  " of it belong to scans that are not read, or to another recording.";
  }
  found.labels = std::make_shared<IndexedLabelSource>(file, std::move(of_scan));
  return found;
}

LabelRule with_unlabelled_ignored(LabelRule rule) {
  const auto unlabelled = static_cast<std::uint16_t>(kUnlabelled);
  if (std::find(rule.moving.begin(), rule.moving.end(), unlabelled) != rule.moving.end()) {
    throw ConfigurationError(
        "label rule '" + rule.name + "': label id 0 moves, but in " + kIndexedLabelsFile +
        " it means scans without labels; leave it out, or add it to \"ignored\".");
  }
  const auto place = std::lower_bound(rule.ignored.begin(), rule.ignored.end(), unlabelled);
  if (place == rule.ignored.end() || *place != unlabelled) rule.ignored.insert(place, unlabelled);
  rule.class_names = indexed_label_rule().class_names;
  return rule;
}

LabelRule indexed_label_rule() {
  LabelRule rule;
  rule.name = "labelled scans";
  rule.moving = {static_cast<std::uint16_t>(kMoving)};
  rule.ignored = {static_cast<std::uint16_t>(kUnlabelled)};
  rule.class_names = {{0, "unlabelled"}, {9, "static"}, {251, "moving"}};
  return rule;
}

}  // namespace raymoval
