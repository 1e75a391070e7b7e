// SPDX-License-Identifier: MIT
#include "datasets/trajectories/pose_format.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "core/angle.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/poses.h"

namespace raymoval::pose_formats {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// A comment, or the "%time,field..." line of `rostopic echo -p`.
bool begins_comment(char c) {
  return c == '#' || c == '%';
}

bool has_letter(std::string_view word) {
  return std::any_of(word.begin(), word.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
}

char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos ? ',' : ' ';
}

}  // namespace

PoseText::PoseText(std::filesystem::path path, std::string content)
    : path_(std::move(path)), content_(std::move(content)) {
  look_at_head();
}

bool PoseText::is_blank_or_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(kBlanks);
  return first == std::string_view::npos || begins_comment(line[first]);
}

std::vector<std::string_view> PoseText::split_words(std::string_view line) const {
  line = without_blanks(line.substr(0, line.find('#')));
  if (separator_ == ' ') {
    std::vector<std::string_view> words = split_blanks(line);
    if (words.size() < 2) return words;
    const std::string_view both =
        line.substr(0, static_cast<std::size_t>(words[1].data() + words[1].size() - line.data()));
    if (!parse_date(both)) return words;
    words.erase(words.begin());
    words.front() = both;
    return words;
  }
  if (line.ends_with(separator_)) line.remove_suffix(1);
  std::vector<std::string_view> words = split(line, separator_);
  for (std::string_view& word : words) word = without_blanks(word);
  return words;
}

void PoseText::look_at_head() {
  std::string_view comment;
  std::size_t number = 0;
  for (std::size_t at = 0; at < content_.size();) {
    const std::size_t end = std::min(content_.find('\n', at), content_.size());
    const std::string_view line = without_blanks(std::string_view(content_).substr(at, end - at));
    at = end + 1;
    ++number;
    if (line.empty()) continue;
    if (begins_comment(line.front())) {
      comment = without_blanks(line.substr(1));
      continue;
    }
    separator_ = separator_of(line);
    first_.words = split_words(line);
    const bool is_header = names_.empty() && first_.words.size() > 2 &&
                           std::all_of(first_.words.begin(), first_.words.end(), has_letter) &&
                           !parse_number<double>(first_.words.front());
    if (is_header && header_line_ == 0) {
      header_line_ = number;
      names_ = std::exchange(first_.words, {});
      continue;
    }
    first_.line = number;
    first_.text = line;
    if (header_line_ == 0 && !comment.empty()) names_ = split_words(comment);
    return;
  }
  first_ = {};
}

std::string PoseText::place(std::size_t line) const {
  return path_.string() + ": line " + std::to_string(line);
}

double PoseText::number(const TextRow& row, std::size_t word) const {
  const std::string_view text = row.words[word];
  if (const auto value = parse_number<double>(text)) return *value;
  const auto column = static_cast<std::size_t>(text.data() - row.text.data()) + 1;
  // "1,5 0 0": decimal commas look like separators.
  const bool blanks_inside = separator_ == ',' && text.find(' ') != std::string_view::npos;
  throw DataError(place(row.line) + ", column " + std::to_string(column) + ": '" +
                  std::string(text.substr(0, 40)) + "' is not a number; expected numbers between " +
                  (separator_ == ' '   ? "blanks."
                   : separator_ == ',' ? "commas."
                                       : "semicolons.") +
                  (blanks_inside ? " If the commas are decimal ones, write points." : ""));
}

std::vector<double> PoseText::numbers(const TextRow& row) const {
  std::vector<double> all;
  for (std::size_t i = 0; i < row.words.size(); ++i) all.push_back(number(row, i));
  return all;
}

namespace {

using Matrix3x4 = Eigen::Matrix<double, 3, 4>;

Eigen::Vector3d chosen(const std::vector<double>& numbers, const std::size_t* at) {
  return {numbers[at[0]], numbers[at[1]], numbers[at[2]]};
}

Matrix3x4 with_position(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& position) {
  Matrix3x4 matrix;
  matrix << rotation, position;
  return matrix;
}

Matrix3x4 matrix_at(const double* numbers) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers);
}

void check_last_row(const double* row, const std::string& where) {
  constexpr double kTolerance = 1e-6;
  const bool good = std::abs(row[0]) <= kTolerance && std::abs(row[1]) <= kTolerance &&
                    std::abs(row[2]) <= kTolerance && std::abs(row[3] - 1.0) <= kTolerance;
  if (good) return;
  throw DataError(where + ": the last row of the 4 x 4 matrix is " + number_text(row[0]) + " " +
                  number_text(row[1]) + " " + number_text(row[2]) + " " + number_text(row[3]) +
                  "; expected 0 0 0 1. A matrix that was written column by column has to be "
                  "transposed.");
}

Eigen::Matrix3d euler_rotation(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

bool has_matrix(const PoseColumns& columns) {
  return columns.rotation == Rotation::kMatrix3x4 || columns.rotation == Rotation::kMatrix4x4;
}

/// Whether the row has the quaternion 0 or a matrix of zeros, as motion capture writes it when it
/// loses its target.
bool is_lost(const std::vector<double>& numbers, const PoseColumns& columns) {
  const auto zero = [](double number) { return number == 0.0; };
  if (has_matrix(columns)) {
    const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(columns.matrix);
    return std::all_of(begin, begin + 12, zero);
  }
  return columns.rotation == Rotation::kQuaternion &&
         std::all_of(columns.turn.begin(), columns.turn.end(),
                     [&](std::size_t at) { return zero(numbers[at]); });
}

/// Whether a number of the pose is not finite.
bool lacks_pose(const std::vector<double>& numbers, const PoseColumns& columns) {
  const auto bad = [&](std::size_t at) { return !std::isfinite(numbers[at]); };
  if (!has_matrix(columns)) {
    return std::any_of(columns.position.begin(), columns.position.end(), bad) ||
           std::any_of(columns.turn.begin(), columns.turn.end(), bad);
  }
  const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(columns.matrix);
  return !std::all_of(begin, begin + 12, [](double number) { return std::isfinite(number); });
}

Eigen::Matrix3d vector_rotation(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

}  // namespace

Matrix3x4 pose_matrix(const std::vector<double>& numbers, const PoseColumns& columns,
                      const std::string& where) {
  if (lacks_pose(numbers, columns) || is_lost(numbers, columns)) {
    return Matrix3x4::Constant(std::nan(""));
  }
  if (columns.rotation == Rotation::kMatrix3x4) return matrix_at(&numbers[columns.matrix]);
  if (columns.rotation == Rotation::kMatrix4x4) {
    check_last_row(&numbers[columns.matrix + 12], where);
    return matrix_at(&numbers[columns.matrix]);
  }
  const Eigen::Vector3d position = chosen(numbers, columns.position.data());
  const Eigen::Vector3d turn = chosen(numbers, columns.turn.data());
  if (columns.rotation == Rotation::kQuaternion) {
    const double w = numbers[columns.turn[3]];
    return rigid_pose(position, {w, turn.x(), turn.y(), turn.z()}, where).matrix().topRows<3>();
  }
  if (columns.rotation == Rotation::kVector) {
    return with_position(vector_rotation(turn), position);
  }
  if (columns.rotation == Rotation::kBoreas) {
    return with_position(euler_rotation(turn).transpose(), position);
  }
  const double unit = columns.rotation == Rotation::kEulerDegrees ? kDegree : 1.0;
  return with_position(euler_rotation(unit * turn), position);
}

void set_stamps(PoseFile& file, const std::vector<std::string_view>& words,
                const std::vector<std::string_view>& extra, std::optional<TimeUnit> unit) {
  const auto place = [&](std::size_t i) { return file.place(i); };
  const StampColumn column = parse_stamps(words, unit, place);
  for (std::size_t i = 0; i < words.size(); ++i) file.rows[i].stamp = column.stamps[i];
  constexpr Nanoseconds kCertain = 100'000'000'000'000'000;  // Only times since 1970 are as large.
  const bool guessed = !unit && column.unit != TimeUnit::kSeconds;
  if (guessed && std::abs(column.stamps.front()) < kCertain) {
    file.notes.push_back(file.path.string() + ": the times are read as " +
                         time_unit_name(column.unit) + ", because of their size.");
  }
  if (extra.empty()) return;
  const StampColumn parts = parse_stamps(extra, TimeUnit::kNanoseconds, place);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool whole = column.stamps[i] % 1'000'000'000 == 0;
    if (!whole || parts.stamps[i] < 0 || parts.stamps[i] >= 1'000'000'000) {
      throw DataError(place(i) + ": seconds " + std::string(words[i]) + " and nanoseconds " +
                      std::string(extra[i]) +
                      "; expected whole seconds, and nanoseconds from 0 to 999999999.");
    }
    *file.rows[i].stamp += parts.stamps[i];
  }
}

/// The numbers of a row; 0 for unused words that are no numbers.
std::vector<double> used_numbers(const PoseText& text, const TextRow& row,
                                 const PoseColumns& columns) {
  std::vector<double> numbers(row.words.size(), 0.0);
  for (std::size_t i = 0; columns.others_are_numbers && i < numbers.size(); ++i) {
    const bool date = i == columns.time && parse_date(row.words[i]);
    if (!date) numbers[i] = text.number(row, i);
  }
  if (columns.others_are_numbers) return numbers;
  for (const std::size_t at : columns.position) numbers[at] = text.number(row, at);
  for (const std::size_t at : columns.turn) numbers[at] = text.number(row, at);
  return numbers;
}

PoseFile read_columns(const PoseText& text, const PoseColumns& columns) {
  PoseFile file;
  file.path = text.path();
  file.has_quaternions = columns.rotation == Rotation::kQuaternion;
  std::vector<std::string_view> times, nanoseconds;
  std::size_t dropped = 0;
  std::string first_lost;
  text.for_each_row([&](const TextRow& row) {
    const std::string where = text.place(row.line);
    if (row.words.size() != columns.count) {
      // Reports a word that is no number first.
      if (columns.others_are_numbers) (void)text.numbers(row);
      throw DataError(where + ": " + std::to_string(row.words.size()) + " numbers; expected " +
                      std::to_string(columns.count) +
                      " as in the rows above; the row looks truncated or doubled.");
    }
    const std::vector<double> numbers = used_numbers(text, row, columns);
    file.rows.push_back({.matrix = pose_matrix(numbers, columns, where), .line = row.line});
    if (first_lost.empty() && is_lost(numbers, columns)) first_lost = where;
    const bool timeless = columns.time && !file.rows.back().has_pose() &&
                          std::isnan(parse_number<double>(row.words[*columns.time]).value_or(0.0));
    if (timeless) {
      file.rows.pop_back();
      ++dropped;
      return;
    }
    if (columns.time) times.push_back(row.words[*columns.time]);
    if (columns.nanoseconds) nanoseconds.push_back(row.words[*columns.nanoseconds]);
  });
  const bool any = std::any_of(file.rows.begin(), file.rows.end(),
                               [](const PoseFile::Row& row) { return row.has_pose(); });
  if (!any && !first_lost.empty()) {  // Both throw.
    if (has_matrix(columns)) (void)rigid_pose(Matrix3x4::Zero(), first_lost);
    (void)rigid_pose(Eigen::Vector3d::Zero(), Eigen::Vector4d::Zero(), first_lost);
  }
  if (columns.time) set_stamps(file, times, nanoseconds, columns.unit);
  if (dropped > 0) {
    file.notes.push_back(file.path.string() + ": " + counted_text(dropped, "row") +
                         " with nan for time and pose are left out.");
  }
  return file;
}

}  // namespace raymoval::pose_formats
