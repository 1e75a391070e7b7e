// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/trajectories/pose_format.h"

namespace raymoval::pose_formats {
namespace {

/// A column name: its parts in small letters, and the text in brackets.
struct ColumnName {
  std::vector<std::string> parts;
  std::string unit;
};

ColumnName parse_name(std::string_view text) {
  ColumnName name;
  std::string part;
  bool in_brackets = false;
  for (const char c : text) {
    const auto small = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (c == '[' || c == '(')
      in_brackets = true;
    else if (c == ']' || c == ')')
      in_brackets = false;
    else if (in_brackets)
      name.unit += small;
    else if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      part += small;
    else if (!part.empty())
      name.parts.push_back(std::exchange(part, ""));
  }
  if (!part.empty()) name.parts.push_back(part);
  return name;
}

bool is_one_of(const std::string& text, const std::vector<std::string>& all) {
  return std::find(all.begin(), all.end(), text) != all.end();
}

/// The meaning of a column: "x", "qw", "roll", "heading", "time", "sec", "nsec", or "" for others.
std::string meaning(const ColumnName& name) {
  if (name.parts.empty()) return "";
  const std::string& last = name.parts.back();
  if (is_one_of(last, {"roll", "pitch", "yaw", "heading"})) return last;
  if (is_one_of(last, {"t", "time", "timestamp", "stamp", "gpstime"})) return "time";
  if (last == "easting") return "x";
  if (last == "northing") return "y";
  if (last == "altitude") return "z";
  if (is_one_of(last, {"sec", "secs", "seconds"})) return "sec";
  if (is_one_of(last, {"nsec", "nsecs", "nanosec", "nanosecs", "nanosecond", "nanoseconds"})) {
    return "nsec";
  }
  const std::string before = name.parts.size() > 1 ? name.parts[name.parts.size() - 2] : "";
  if (parse_time_unit(last) && is_one_of(before, {"t", "time", "timestamp", "stamp"})) {
    return "time";
  }
  const char axis = last.back();
  if (axis < 'w' || axis > 'z') return "";
  // "qx" and "tx" in one part, or "orientation" and "x" in two. EuRoC: p_RS_R_x, q_RS_w.
  const bool alone = last.size() == 1;
  const bool euroc = name.parts.size() > 2 && name.parts[1] == "rs";
  const std::string kind = euroc   ? name.parts.front()
                           : alone ? before
                                   : last.substr(0, last.size() - 1);
  if (is_one_of(kind, {"q", "quat", "quaternion", "orientation", "rot", "rotation"})) {
    // A rotation of three numbers is no quaternion: its w is missing.
    return std::string("q") + axis;
  }
  if (axis == 'w') return alone && name.parts.size() == 1 ? "qw" : "";
  const bool position = (alone && name.parts.size() == 1) ||
                        is_one_of(kind, {"t", "p", "pos", "position", "trans", "translation"});
  return position ? std::string(1, axis) : "";
}

std::optional<TimeUnit> unit_of(const ColumnName& name) {
  if (!name.unit.empty()) return parse_time_unit(name.unit);
  const std::string& last = name.parts.back();
  return last == "t" ? std::nullopt : parse_time_unit(last);
}

/// The first column of each meaning.
std::map<std::string, std::size_t> meanings(const std::vector<std::string_view>& names) {
  std::map<std::string, std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string what = meaning(parse_name(names[i]));
    // `rostopic echo -p` has the time of recording first, then the time of the message.
    const bool better = what == "time" && names[i].find("header.stamp") != std::string_view::npos;
    if (!what.empty() && (better || found.count(what) == 0)) found[what] = i;
  }
  return found;
}

bool has_all(const std::map<std::string, std::size_t>& found,
             const std::vector<std::string>& names) {
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return found.count(name) > 0; });
}

/// The columns; empty if position or rotation is missing.
std::optional<PoseColumns> columns_of(const PoseText& text) {
  const auto found = meanings(text.names());
  if (text.names().empty() || !has_all(found, {"x", "y", "z"})) return std::nullopt;
  PoseColumns columns;
  columns.count = text.names().size();
  columns.others_are_numbers = false;
  columns.position = {found.at("x"), found.at("y"), found.at("z")};
  if (has_all(found, {"qx", "qy", "qz", "qw"})) {
    columns.turn = {found.at("qx"), found.at("qy"), found.at("qz"), found.at("qw")};
  } else if (has_all(found, {"roll", "pitch", "heading"})) {
    columns.rotation = Rotation::kBoreas;
    const std::size_t heading = found.at("heading");
    columns.turn = {found.at("roll"), found.at("pitch"), heading, heading};
  } else if (has_all(found, {"roll", "pitch", "yaw"})) {
    columns.rotation = Rotation::kEulerRadians;
    const std::size_t yaw = found.at("yaw");
    columns.turn = {found.at("roll"), found.at("pitch"), yaw, yaw};
    if (parse_name(text.names()[yaw]).unit.starts_with("deg")) {
      columns.rotation = Rotation::kEulerDegrees;
    }
  } else {
    return std::nullopt;
  }
  if (has_all(found, {"sec", "nsec"})) {
    columns.time = found.at("sec");
    columns.nanoseconds = found.at("nsec");
    columns.unit = TimeUnit::kSeconds;
  } else {
    for (const char* what : {"time", "sec", "nsec"}) {
      if (columns.time || found.count(what) == 0) continue;
      columns.time = found.at(what);
      columns.unit = unit_of(parse_name(text.names()[*columns.time]));
    }
  }
  return columns;
}

Match match_named_columns(const PoseText& text) {
  const auto columns = columns_of(text);
  // A comment without column names may have as many words by chance.
  const bool fits = columns && text.first().words.size() == columns->count;
  if (text.has_header()) return columns ? Match::kYes : Match::kNo;
  return fits ? Match::kYes : Match::kNo;
}

/// Angles beyond two turns are in degrees, not radians.
void check_angles(const PoseText& text, PoseColumns& columns, std::vector<std::string>& notes) {
  if (columns.rotation != Rotation::kEulerRadians) return;
  constexpr double kMostRadians = 6.3;
  double most = 0.0;
  text.for_each_row([&](const TextRow& row) {
    for (const std::size_t at : columns.turn) {
      if (at < row.words.size()) most = std::max(most, std::abs(text.number(row, at)));
    }
  });
  if (most <= kMostRadians) return;
  columns.rotation = Rotation::kEulerDegrees;
  notes.push_back(text.path().string() +
                  ": roll, pitch and yaw are read as degrees, because of their size.");
}

PoseFile read_named_columns(const PoseText& text) {
  auto columns = columns_of(text);
  if (!columns) {
    std::vector<std::string> names(text.names().begin(), text.names().end());
    throw DataError(text.path().string() + ": the line of names has " +
                    (names.empty() ? "nothing" : join(names)) +
                    "; expected x y z with qx qy qz qw or roll pitch yaw, and a time.");
  }
  std::vector<std::string> notes;
  check_angles(text, *columns, notes);
  if (columns->rotation == Rotation::kBoreas) {
    notes.push_back(text.path().string() +
                    ": roll, pitch and heading are read as pyboreas does, Rx(-roll) Ry(-pitch) "
                    "Rz(-heading). If they are those of Rz Ry Rx, name the last column yaw.");
  }
  PoseFile file = read_columns(text, *columns);
  file.notes.insert(file.notes.begin(), notes.begin(), notes.end());
  return file;
}

}  // namespace

TextFormat named_columns_format() {
  return {{"csv",
           "columns in any order with a line of names above them: a time (or sec and nsec), x y z, "
           "qx qy qz qw or roll pitch yaw; also Boreas' easting ... heading"},
          match_named_columns,
          read_named_columns};
}

}  // namespace raymoval::pose_formats
