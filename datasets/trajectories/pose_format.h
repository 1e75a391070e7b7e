// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"

namespace raymoval::pose_formats {

/// A line that is neither empty nor a comment.
struct TextRow {
  std::size_t line = 0;  ///< Counted from 1.
  std::string_view text;
  std::vector<std::string_view> words;
};

/// A text with a row of words per line, separated by blanks, commas or semicolons.
class PoseText {
 public:
  PoseText(std::filesystem::path path, std::string content);
  PoseText(const PoseText&) = delete;
  PoseText& operator=(const PoseText&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// The separator of the first row: ' ', ',' or ';'.
  [[nodiscard]] char separator() const { return separator_; }
  /// The column names: from a first line without numbers, or from the last comment above the
  /// numbers. Empty if there is no such line.
  [[nodiscard]] const std::vector<std::string_view>& names() const { return names_; }
  /// Whether the names are in a line that is no comment.
  [[nodiscard]] bool has_header() const { return header_line_ > 0; }
  /// The first row of numbers; without words if there is none.
  [[nodiscard]] const TextRow& first() const { return first_; }
  /// "poses.txt: line 12".
  [[nodiscard]] std::string place(std::size_t line) const;

  /// Calls `visit(TextRow)` for each row of numbers.
  template <class Visit>
  void for_each_row(Visit&& visit) const {
    std::size_t number = 0;
    TextRow row;
    for (std::size_t at = 0; at < content_.size();) {
      const std::size_t end = std::min(content_.find('\n', at), content_.size());
      row.text = std::string_view(content_).substr(at, end - at);
      at = end + 1;
      row.line = ++number;
      if (number == header_line_ || is_blank_or_comment(row.text)) continue;
      row.words = split_words(row.text);
      visit(row);
    }
  }

  /// Word `word` of `row` as a number.
  /// @throws DataError with file, line and column if it is no number
  [[nodiscard]] double number(const TextRow& row, std::size_t word) const;
  /// All words of `row` as numbers.
  [[nodiscard]] std::vector<double> numbers(const TextRow& row) const;

 private:
  static bool is_blank_or_comment(std::string_view line);
  /// Text behind a # is ignored; a date and the time of day behind it are one word.
  [[nodiscard]] std::vector<std::string_view> split_words(std::string_view line) const;
  void look_at_head();

  std::filesystem::path path_;
  std::string content_;
  char separator_ = ' ';
  std::vector<std::string_view> names_;
  std::size_t header_line_ = 0;
  TextRow first_;
};

/// The form of a rotation in a row of numbers.
enum class Rotation {
  kMatrix3x4,     ///< Twelve numbers with the position among them.
  kMatrix4x4,     ///< Sixteen; the last four are 0 0 0 1.
  kQuaternion,    ///< x y z w.
  kVector,        ///< Axis times angle, radians.
  kEulerRadians,  ///< Roll, pitch, yaw of Rz(yaw) Ry(pitch) Rx(roll).
  kEulerDegrees,
  kBoreas,  ///< Roll, pitch, heading of Rx(-roll) Ry(-pitch) Rz(-heading), as in pyboreas.
};

/// The meaning of the numbers of a row.
struct PoseColumns {
  std::size_t count = 0;           ///< Words in a row.
  bool others_are_numbers = true;  ///< Whether unused words must be numbers.
  Rotation rotation = Rotation::kQuaternion;
  std::size_t matrix = 0;                       ///< First number of a matrix.
  std::array<std::size_t, 3> position = {};     ///< x y z, if there is no matrix.
  std::array<std::size_t, 4> turn = {};         ///< The numbers of the rotation, in its order.
  std::optional<std::size_t> time;              ///< Seconds, or in `unit`.
  std::optional<std::size_t> nanoseconds;       ///< To be added to whole seconds in `time`.
  std::optional<TimeUnit> unit = std::nullopt;  ///< Empty: detected from the times.
};

/// The pose in a row of numbers.
/// @throws DataError that begins with `where` for a bad quaternion or fourth row
Eigen::Matrix<double, 3, 4> pose_matrix(const std::vector<double>& numbers,
                                        const PoseColumns& columns, const std::string& where);

/// Reads all rows of a text.
/// @throws DataError naming file and line for a row with another number of columns
PoseFile read_columns(const PoseText& text, const PoseColumns& columns);

/// Gives the rows of `file` their times.
/// @param words a time for each row; `extra` has nanoseconds to be added, or is empty
/// @throws DataError for a word that is no time
void set_stamps(PoseFile& file, const std::vector<std::string_view>& words,
                const std::vector<std::string_view>& extra, std::optional<TimeUnit> unit);

/// How certain it is, by its content, that a text is of a format.
enum class Match {
  kNo,
  kPossible,  ///< It fits, but so does another order of the columns.
  kYes,
};

/// A pose format that is text.
struct TextFormat {
  PoseFormatName name;
  std::function<Match(const PoseText&)> match;
  std::function<PoseFile(const PoseText&)> read;
};

/// Rows of numbers whose order is fixed: kitti, matrix, tum, euroc, fast-lio, ct-icp, hba.
std::vector<TextFormat> column_formats();
/// Columns with their names above them.
TextFormat named_columns_format();
/// Pose graphs of g2o.
TextFormat g2o_format();

/// The names of the formats that are no text of rows.
std::vector<PoseFormatName> binary_format_names();

/// Reads `path` if it is, or is given as, an .npy array of matrices or a .pcd file of key poses.
/// @return empty if it is a text of rows
/// @throws DataError
std::optional<PoseFile> read_binary_poses(const std::filesystem::path& path,
                                          const PoseReading& reading);

}  // namespace raymoval::pose_formats
