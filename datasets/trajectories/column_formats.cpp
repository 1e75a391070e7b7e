// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "datasets/trajectories/pose_format.h"

namespace raymoval::pose_formats {
namespace {

constexpr double kUnit = 1e-3;  // Largest deviation of a quaternion's length from 1.

/// Columns of a matrix behind a time, or alone.
PoseColumns matrix_columns(Rotation rotation, std::size_t numbers, bool has_time) {
  PoseColumns columns;
  columns.rotation = rotation;
  columns.matrix = has_time ? 1 : 0;
  columns.count = numbers + columns.matrix;
  if (has_time) columns.time = 0;
  return columns;
}

/// Columns of a position and a quaternion, or another rotation.
PoseColumns turn_columns(std::size_t count, std::optional<std::size_t> time,
                         const std::array<std::size_t, 3>& position,
                         const std::array<std::size_t, 4>& turn) {
  PoseColumns columns;
  columns.count = count;
  columns.time = time;
  columns.position = position;
  columns.turn = turn;
  return columns;
}

PoseColumns fast_lio_columns() {
  PoseColumns columns = turn_columns(25, 0, {4, 5, 6}, {1, 2, 3, 3});
  columns.rotation = Rotation::kVector;
  columns.unit = TimeUnit::kSeconds;
  return columns;
}

/// The entry of `all` with `count` words; null if there is none.
const PoseColumns* columns_of(const std::vector<PoseColumns>& all, std::size_t count) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const PoseColumns& one) { return one.count == count; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<double> first_numbers(const PoseText& text) {
  std::vector<double> numbers;
  for (const std::string_view word : text.first().words) {
    numbers.push_back(parse_number<double>(word).value_or(std::nan("")));
  }
  return numbers;
}

bool ends_with_unit_row(const std::vector<double>& numbers) {
  const std::size_t n = numbers.size();
  return n >= 4 && numbers[n - 4] == 0.0 && numbers[n - 3] == 0.0 && numbers[n - 2] == 0.0 &&
         numbers[n - 1] == 1.0;
}

/// The order of quaternions in rows of eight numbers between commas. A vehicle mostly turns about
/// z, so x and y of its quaternions are small. (The length does not depend on the order.)
enum class QuaternionOrder { kUnknown, kScalarFirst, kScalarLast };

QuaternionOrder quaternion_order(const PoseText& text) {
  constexpr double kSmall = 0.2;
  double last = 0.0, first = 0.0;  // Largest x or y under each order.
  text.for_each_row([&](const TextRow& row) {
    if (row.words.size() < 8) return;
    const double a = text.number(row, 4), b = text.number(row, 5), c = text.number(row, 6);
    last = std::max(last, std::hypot(a, b));
    first = std::max(first, std::hypot(b, c));
  });
  if (last <= kSmall && first > kSmall) return QuaternionOrder::kScalarLast;
  if (first <= kSmall && last > kSmall) return QuaternionOrder::kScalarFirst;
  // Both small: only the last number is large. It is w, unless the vehicle turned by 180 degrees.
  return last <= kSmall ? QuaternionOrder::kScalarLast : QuaternionOrder::kUnknown;
}

/// Whether times are whole nanoseconds since 1970, as in EuRoC's files.
bool has_nanoseconds(const PoseText& text) {
  const std::string_view time = text.first().words.front();
  return time.size() >= 17 && all_digits(time);
}

/// Whether a text of eight numbers per row is EuRoC's, and not in TUM's order.
/// @throws DataError if that is ambiguous
bool is_euroc_of_eight(const PoseText& text) {
  if (text.separator() == ' ') return false;
  const QuaternionOrder order = quaternion_order(text);
  const bool nanoseconds = has_nanoseconds(text);
  if (!nanoseconds && order != QuaternionOrder::kScalarFirst) return false;
  if (nanoseconds && order == QuaternionOrder::kScalarFirst) return true;
  throw DataError(text.path().string() +
                  ": eight numbers a row between commas, without a line of names: the order of the "
                  "quaternion is unknown. Use --pose-format tum if w is the last number (t x y z "
                  "qx qy qz qw), or --pose-format euroc if it is the first of the four.");
}

Match match_matrix(const PoseText& text) {
  const std::size_t count = text.first().words.size();
  if (count == 4 || count == 16) return Match::kYes;
  return count == 17 && ends_with_unit_row(first_numbers(text)) ? Match::kYes : Match::kNo;
}

Match match_euroc(const PoseText& text) {
  const std::size_t count = text.first().words.size();
  if (count == 17) return ends_with_unit_row(first_numbers(text)) ? Match::kNo : Match::kYes;
  return count == 8 && is_euroc_of_eight(text) ? Match::kYes : Match::kNo;
}

Match match_tum(const PoseText& text) {
  const bool fits = text.first().words.size() == 8 && !is_euroc_of_eight(text);
  return fits ? Match::kYes : Match::kNo;
}

/// Accepts seven numbers as position and quaternion only in a file of HBA's name. A first number
/// that large is a time (NCLT's tables).
Match match_hba(const PoseText& text) {
  constexpr double kLargest = 1e8;
  if (text.first().words.size() != 7 || first_numbers(text).front() > kLargest) return Match::kNo;
  return text.path().extension() == ".json" ? Match::kYes : Match::kPossible;
}

[[noreturn]] void throw_count(const PoseText& text, const PoseFormatName& name) {
  const TextRow& row = text.first();
  if (!row.words.empty()) (void)text.numbers(row);  // Reports a word that is no number first.
  throw DataError(text.place(row.line) + ": " + std::to_string(row.words.size()) +
                  " numbers; expected, for a file of format " + name.name + ", " + name.sentence +
                  ".");
}

/// Rows of a matrix behind a time or, as in KITTI-360, a frame number: whole numbers that are too
/// small for times since 1970 in any unit.
PoseFile read_numbered(const PoseText& text, PoseColumns columns) {
  constexpr std::size_t kMostDigits = 8;
  std::vector<long> frames;
  bool numbered = columns.time.has_value();
  text.for_each_row([&](const TextRow& row) {
    const std::string_view word = row.words.front();
    numbered = numbered && word.size() <= kMostDigits && all_digits(word);
    if (numbered) frames.push_back(parse_number<long>(word).value_or(0));
  });
  if (!numbered) return read_columns(text, columns);
  columns.time.reset();
  PoseFile file = read_columns(text, columns);
  for (std::size_t i = 0; i < frames.size(); ++i) file.rows[i].frame = frames[i];
  file.notes.push_back(
      file.path.string() +
      ": the first column is read as frame numbers, because they are whole numbers.");
  return file;
}

/// @param columns for each possible number of words in a row
TextFormat fixed(const PoseFormatName& name, const std::vector<PoseColumns>& columns,
                 std::function<Match(const PoseText&)> match = nullptr) {
  if (!match) {
    match = [columns](const PoseText& text) {
      return columns_of(columns, text.first().words.size()) != nullptr ? Match::kYes : Match::kNo;
    };
  }
  const auto read = [name, columns](const PoseText& text) {
    const PoseColumns* fitting = columns_of(columns, text.first().words.size());
    if (fitting == nullptr) throw_count(text, name);
    const bool matrix = fitting->count == 13 || fitting->count == 17;
    return matrix && fitting->time ? read_numbered(text, *fitting) : read_columns(text, *fitting);
  };
  return {name, match, read};
}

/// A matrix of 16 numbers, and the place of its last number in the text.
struct Block {
  std::vector<double> numbers = {};
  std::size_t line = 0, last_line = 0;
  std::string_view last = {};
};

/// Matrices of four rows with four numbers, or of 16 numbers a row.
std::vector<Block> blocks_of(const PoseText& text) {
  const std::size_t words = text.first().words.size();
  std::vector<Block> blocks;
  text.for_each_row([&](const TextRow& row) {
    const auto part = text.numbers(row);
    if (part.size() != words) {
      throw DataError(text.place(row.line) + ": " + std::to_string(part.size()) +
                      " numbers; expected " + std::to_string(words) +
                      " as in the rows above; the row looks truncated or doubled.");
    }
    if (blocks.empty() || blocks.back().numbers.size() == 16) blocks.push_back({{}, row.line});
    blocks.back().last_line = row.line;
    blocks.back().numbers.insert(blocks.back().numbers.end(), part.begin(), part.end());
    blocks.back().last = row.words.back();
  });
  if (!blocks.empty() && blocks.back().numbers.size() < 16) {
    throw DataError(text.place(blocks.back().last_line) +
                    ": the file ends within a matrix; expected blocks of "
                    "four lines with four numbers each.");
  }
  return blocks;
}

/// Matrices whose last row is 0 0 0 1, or 0 0 0 and the time of the pose.
PoseFile read_blocks(const PoseText& text) {
  const PoseColumns columns = matrix_columns(Rotation::kMatrix4x4, 16, false);
  std::vector<Block> blocks = blocks_of(text);
  const bool timed =
      std::count_if(blocks.begin(), blocks.end(),
                    [](const Block& block) { return block.numbers[15] == 1.0; }) < 2 &&
      blocks.size() > 1 && std::all_of(blocks.begin(), blocks.end(), [](const Block& block) {
        const auto& n = block.numbers;
        return n[12] == 0.0 && n[13] == 0.0 && n[14] == 0.0;
      });
  PoseFile file;
  file.path = text.path();
  std::vector<std::string_view> times;
  for (Block& block : blocks) {
    times.push_back(block.last);
    if (timed) block.numbers[15] = 1.0;
    file.rows.push_back({.matrix = pose_matrix(block.numbers, columns, text.place(block.last_line)),
                         .line = block.line});
  }
  if (!timed) return file;
  set_stamps(file, times, {}, std::nullopt);
  file.notes.push_back(file.path.string() +
                       ": the last number of each matrix is read as the time of the pose.");
  return file;
}

/// Splits a word of CT-ICP, which writes no blank between the time of the reference and the first
/// number of the quaternion ("-10.25" is -1 and 0.25). The quaternion has length 1 after the right
/// split.
/// @return the first number of the quaternion
double cut_quaternion(const PoseText& text, const TextRow& row, std::size_t word) {
  constexpr std::size_t kLongest = 64;
  double rest = 1.0;
  for (std::size_t i = 1; i < 4; ++i) rest -= std::pow(text.number(row, word + i), 2);
  const double size = std::sqrt(std::max(rest, 0.0));
  const std::string_view both = row.words[word];
  for (std::size_t cut = 1; cut < std::min(both.size(), kLongest); ++cut) {
    const auto time = parse_number<double>(both.substr(0, cut));
    const auto number = parse_number<double>(both.substr(cut));
    if (!time || !number || !(std::abs(std::abs(*number) - size) < kUnit)) continue;
    return *number;
  }
  throw DataError(text.place(row.line) + ": '" + std::string(both.substr(0, 40)) +
                  "' is not the time and the first number of a quaternion that CT-ICP writes "
                  "without a blank between them.");
}

PoseFile read_ct_icp(const PoseText& text, const PoseFormatName& name) {
  const std::size_t count = text.first().words.size();
  if (count != 20 && count != 22) throw_count(text, name);
  // Id, time, id and time of the reference, quaternion, position; twice: at the begin and the end.
  PoseColumns columns;
  columns.turn = {3, 4, 5, 6};
  columns.position = {7, 8, 9};
  PoseFile file;
  file.path = text.path();
  file.has_quaternions = true;
  std::vector<std::string_view> times;
  text.for_each_row([&](const TextRow& row) {
    const std::string where = text.place(row.line);
    if (row.words.size() != count) {
      throw DataError(where + ": " + std::to_string(row.words.size()) + " numbers; expected " +
                      std::to_string(count) +
                      " as in the rows above; the row looks truncated or doubled.");
    }
    const std::size_t skipped = count == 22 ? 1 : 0;
    std::vector<double> numbers(10, 0.0);
    for (std::size_t i = 4; i < 10; ++i) numbers[i] = text.number(row, i + skipped);
    numbers[3] = count == 22 ? text.number(row, 4) : cut_quaternion(text, row, 3);
    file.rows.push_back({.matrix = pose_matrix(numbers, columns, where), .line = row.line});
    times.push_back(row.words[1]);
  });
  set_stamps(file, times, {}, std::nullopt);
  file.notes.push_back(
      text.path().string() +
      ": CT-ICP gives two poses for each scan; that of its begin is used. With --deskew the "
      "sensor moves evenly from the begin of a scan to that of the next one.");
  return file;
}

TextFormat ct_icp() {
  const PoseFormatName name = {"ct-icp", "CT-ICP's trajectory, two poses a row (20 or 22 numbers)"};
  const auto match = [](const PoseText& text) {
    const std::size_t count = text.first().words.size();
    return count == 20 || count == 22 ? Match::kYes : Match::kNo;
  };
  return {name, match, [name](const PoseText& text) { return read_ct_icp(text, name); }};
}

/// A file of matrices in blocks or in rows.
TextFormat matrix() {
  TextFormat rows = fixed(
      {"matrix",
       "4 x 4 matrices: 16 numbers a row, blocks of four lines, or a time or frame number and 16 "
       "numbers; the last row is 0 0 0 1 or 0 0 0 time"},
      {matrix_columns(Rotation::kMatrix4x4, 16, true)}, match_matrix);
  rows.read = [read_rows = rows.read](const PoseText& text) {
    const std::size_t words = text.first().words.size();
    return words == 4 || words == 16 ? read_blocks(text) : read_rows(text);
  };
  return rows;
}

}  // namespace

std::vector<TextFormat> column_formats() {
  return {
      fixed(
          {"kitti",
           "12 numbers a row, a 3 x 4 matrix row by row (KITTI, KISS-ICP's _kitti.txt), or a time "
           "(MulRan) or frame number (KITTI-360) and 12 numbers"},
          {matrix_columns(Rotation::kMatrix3x4, 12, false),
           matrix_columns(Rotation::kMatrix3x4, 12, true)}),
      matrix(),
      fixed({"tum",
             "8 numbers a row, t x y z qx qy qz qw (GLIM's traj_lidar.txt, KISS-ICP's _tum.txt, "
             "evo)"},
            {turn_columns(8, 0, {1, 2, 3}, {4, 5, 6, 7})}, match_tum),
      fixed({"euroc",
             "8 or 17 numbers a row between commas, nanoseconds x y z qw qx qy qz ... (EuRoC)"},
            {turn_columns(8, 0, {1, 2, 3}, {5, 6, 7, 4}),
             turn_columns(17, 0, {1, 2, 3}, {5, 6, 7, 4})},
            match_euroc),
      fixed({"fast-lio",
             "25 numbers a row, seconds since the first scan, rotation vector, position ... "
             "(FAST-LIO's pos_log.txt)"},
            {fast_lio_columns()}),
      ct_icp(),
      fixed({"hba", "7 numbers a row, x y z qw qx qy qz, without a time (pose.json of HBA, BALM)"},
            {turn_columns(7, std::nullopt, {0, 1, 2}, {4, 5, 6, 3})}, match_hba),
  };
}

}  // namespace raymoval::pose_formats
