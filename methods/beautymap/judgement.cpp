// SPDX-License-Identifier: MIT
#include "methods/beautymap/column_map.h"

#include "core/sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace raymoval::beautymap_method {
namespace {

// Constants of the public program.
constexpr double kBlindRange = 2.0;    ///< Columns nearer to the sensor are not judged, metres.
constexpr int kRayMargin = 3;          ///< Points this near to the sensor hide nothing, columns.
constexpr double kGroundShare = 0.85;  ///< Of the points of a slice, counted from below.

/// The columns around the sensor of one scan, with the scan's points in them.
class ScanWindow {
 public:
  /// @param placed the places of the scan's points in the map
  ScanWindow(const Parameters& parameters, const ColumnMap& map, const Scan& scan,
             const std::vector<PlacedPoint>& placed);

  /// One column of the window.
  struct Cell {
    std::uint32_t column = ColumnMap::kNone;     ///< Number in the map.
    std::uint32_t seen = 0;                      ///< Bit i: the scan has points in slice i.
    bool has_lower = false, has_higher = false;  ///< Points in a slice up to the top one, or above.
  };

  /// Whether none of the scan's points is in the window.
  [[nodiscard]] bool is_empty() const { return is_empty_; }
  [[nodiscard]] int side() const { return side_; }      ///< Columns.
  [[nodiscard]] int center() const { return center_; }  ///< The sensor's column, in x and in y.
  [[nodiscard]] const Cell& at(int x, int y) const { return cells_[number(x, y)]; }
  /// The foot of a column of the window, metres; where the map has none, the map's lowest point.
  [[nodiscard]] double foot(int x, int y) const;
  /// The foot of the sensor's column, or a substitute, metres.
  [[nodiscard]] double center_foot() const { return center_foot_; }
  [[nodiscard]] double sensor_z() const { return sensor_.z(); }  ///< Metres.
  /// The steepest upward ray with a return, metres of height per metre of horizontal distance.
  [[nodiscard]] double steepest() const { return steepest_; }

 private:
  [[nodiscard]] std::size_t number(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(y);
  }
  void place(const Parameters& parameters);
  void find_columns();
  void enter(const Parameters& parameters, const std::vector<PlacedPoint>& placed);
  void find_steepest(const Scan& scan);
  [[nodiscard]] double foot_around() const;

  const ColumnMap& map_;
  Eigen::Vector3d sensor_;
  ColumnIndex first_;  ///< The column (0, 0) of the window.
  int side_ = 0, center_ = 0;
  double center_foot_ = 0.0, steepest_ = 0.0;
  bool is_empty_ = true;
  std::vector<Cell> cells_;
};

ScanWindow::ScanWindow(const Parameters& parameters, const ColumnMap& map, const Scan& scan,
                       const std::vector<PlacedPoint>& placed)
    : map_(map), sensor_(scan.T_world_sensor.translation()) {
  place(parameters);
  find_columns();
  enter(parameters, placed);
  find_steepest(scan);
  const bool is_known = at(center_, center_).column != ColumnMap::kNone;
  center_foot_ = parameters.public_lattice || is_known ? foot(center_, center_) : foot_around();
}

void ScanWindow::place(const Parameters& parameters) {
  const Lattice& lattice = map_.lattice();
  center_ = static_cast<int>(parameters.window_side / lattice.column_size) / 2;
  if (!parameters.public_lattice) {
    const ColumnIndex own = lattice.column_of(sensor_);
    first_ = {own.x - center_, own.y - center_};
    side_ = 2 * center_ + 1;
    return;
  }
  // B.1: rounded down to whole metres, then to columns.
  side_ = static_cast<int>(parameters.window_side / lattice.column_size);
  const auto first = [&](double position) {
    const double meters = std::trunc(position) - center_ * lattice.column_size;
    return static_cast<int>(meters / lattice.column_size);
  };
  first_ = {first(sensor_.x() - lattice.origin.x()), first(sensor_.y() - lattice.origin.y())};
}

void ScanWindow::find_columns() {
  cells_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
  for (int x = 0; x < side_; ++x) {
    for (int y = 0; y < side_; ++y) {
      cells_[number(x, y)].column = map_.find({first_.x + x, first_.y + y});
    }
  }
}

void ScanWindow::enter(const Parameters& parameters, const std::vector<PlacedPoint>& placed) {
  for (const PlacedPoint& point : placed) {
    const ColumnIndex& column = map_.columns()[point.column].index;
    const int x = column.x - first_.x, y = column.y - first_.y;
    if (x < 0 || y < 0 || x >= side_ || y >= side_) continue;
    Cell& cell = cells_[number(x, y)];
    is_empty_ = false;
    cell.has_higher |= point.slice > kTopSlice;
    cell.has_lower |= point.slice <= kTopSlice;
    if (point.slice >= 0 && point.slice <= kTopSlice) cell.seen |= std::uint32_t{1} << point.slice;
  }
  for (Cell& cell : cells_) {
    if (cell.has_higher && (cell.has_lower || !parameters.public_top)) {
      cell.seen |= std::uint32_t{1} << kTopSlice;
    }
  }
}

void ScanWindow::find_steepest(const Scan& scan) {
  steepest_ = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& point : scan.points) {
    // The direction in the world's axes, since the sensor may be tilted.
    const Eigen::Vector3d ray = scan.T_world_sensor.linear() * point.cast<double>();
    const double way = ray.head<2>().norm();
    if (way > 0.0) steepest_ = std::max(steepest_, ray.z() / way);
  }
}

double ScanWindow::foot(int x, int y) const {
  const std::uint32_t column = at(x, y).column;
  return column == ColumnMap::kNone ? map_.lowest() : map_.columns()[column].foot;
}

double ScanWindow::foot_around() const {
  const int reach = std::min(kOutlierReach, center_);
  std::vector<double> feet;
  for (int x = center_ - reach; x <= center_ + reach; ++x) {
    for (int y = center_ - reach; y <= center_ + reach; ++y) {
      if (at(x, y).column != ColumnMap::kNone) feet.push_back(foot(x, y));
    }
  }
  return feet.empty() ? map_.lowest() : median(std::move(feet));
}

constexpr std::uint32_t kAllSlices = (std::uint32_t{1} << kSlices) - 1;

/// Slices `first` and above.
std::uint32_t slices_from(double first) {
  if (first >= kSlices) return 0;
  return kAllSlices & ~((std::uint32_t{1} << static_cast<int>(std::max(first, 0.0))) - 1);
}

/// Whether a column is within the blind range of the sensor. Offsets in columns.
bool is_blind(const Parameters& parameters, int dx, int dy) {
  const int reach = static_cast<int>(kBlindRange / parameters.column_size) + 1;
  const int end = parameters.public_lattice ? reach - 1 : reach;
  return dx >= -reach && dx <= end && dy >= -reach && dy <= end;
}

/// Step 5: slices out of the scan's sight, which it cannot judge.
std::uint32_t out_of_sight(const Parameters& parameters, const Lattice& lattice,
                           const ScanWindow& window, int x, int y, bool is_outlier) {
  const int dx = x - window.center(), dy = y - window.center();
  if (is_blind(parameters, dx, dy)) return kAllSlices;
  const std::uint32_t seen = window.at(x, y).seen;
  const double sight = parameters.sight_range / lattice.column_size;
  const double squared = static_cast<double>(dx * dx + dy * dy);
  if ((seen & 1) == 0 && squared >= sight * sight) return kAllSlices;
  const std::uint32_t above_first = seen & ~std::uint32_t{1};
  if (above_first != 0 && !is_outlier) return slices_from(std::bit_width(above_first) - 1);
  const double eye = (window.sensor_z() - window.center_foot()) / lattice.slice_height + 0.5;
  const double rise = window.steepest() * lattice.column_size / lattice.slice_height;
  return slices_from(std::trunc(eye + std::sqrt(squared) * rise + 0.5));
}

/// The walk from the sensor's column to another one, in steps of one column along the longer axis.
class Walk {
 public:
  Walk(int dx, int dy, bool is_public)
      : dx_(dx), dy_(dy), length_(std::max(std::abs(dx), std::abs(dy))), is_public_(is_public) {}

  [[nodiscard]] int length() const { return length_; }
  [[nodiscard]] int x(int step) const { return at(step, dx_); }
  [[nodiscard]] int y(int step) const { return at(step, dy_); }
  /// Columns from the sensor's, along x and y together.
  [[nodiscard]] int way(int step) const {
    return step * std::abs(dx_) / length_ + step * std::abs(dy_) / length_;
  }

 private:
  [[nodiscard]] int at(int step, int whole) const {
    if (!is_public_) {  // To the nearest, ties away from the sensor: the same in all directions.
      const int steps = (2 * step * std::abs(whole) + length_) / (2 * length_);
      return whole < 0 ? -steps : steps;
    }
    const int product = step * whole;  // Rounded down.
    return product >= 0 ? product / length_ : -((-product + length_ - 1) / length_);
  }

  int dx_, dy_, length_;
  bool is_public_;
};

/// The slice, in the column at (x, y), of the ray to slice `slice` of the column at (to_x, to_y),
/// at the share `share` of its length.
double slice_on_ray(const Parameters& parameters, const Lattice& lattice, const ScanWindow& window,
                    int x, int y, double to_foot, int slice, double share) {
  const double h = lattice.slice_height;
  if (parameters.public_rays) {
    const double eye = (window.sensor_z() - window.center_foot()) / h + 0.5;
    return std::trunc(window.foot(x, y) - window.center_foot() + (slice - eye) * share + eye + 0.5);
  }
  const double end = to_foot + (slice + 0.5) * h;
  const double z = window.sensor_z() + (end - window.sensor_z()) * share;
  return std::floor((z - window.foot(x, y)) / h);
}

/// Steps 4 to 6 for one column of the window: slices that are occupied in the map and not in the
/// scan, without slices out of sight and without the lowest slice. Bit i is slice i.
std::uint32_t suspicious_slices(const Parameters& parameters, const ColumnMap& map,
                                const ScanWindow& window, int x, int y) {
  const ScanWindow::Cell& cell = window.at(x, y);
  if (cell.column == ColumnMap::kNone) return 0;
  const Column& column = map.columns()[cell.column];
  const std::uint32_t missing = column.occupied & ~cell.seen;
  const std::uint32_t above_lowest = column.occupied & (column.occupied - 1);
  if ((missing & above_lowest) == 0) return 0;
  return missing & above_lowest &
         ~out_of_sight(parameters, map.lattice(), window, x, y, column.is_outlier);
}

/// Step 7: the slices among these that are hidden by points of the scan on the ray to them.
std::uint32_t hidden_slices(const Parameters& parameters, const Lattice& lattice,
                            const ScanWindow& window, int x, int y, std::uint32_t suspicious) {
  const int center = window.center();
  const Walk walk(x - center, y - center, parameters.public_rays);
  if (walk.length() == 0) return 0;
  const double to_foot = window.foot(x, y);
  std::uint32_t hidden = 0;
  for (int step = 1;; ++step) {
    const int at_x = center + walk.x(step), at_y = center + walk.y(step);
    if (at_x < 0 || at_y < 0 || at_x >= window.side() || at_y >= window.side()) break;
    if (!parameters.public_rays && step >= walk.length()) break;
    if (walk.way(step) <= kRayMargin) continue;
    const std::uint32_t seen = window.at(at_x, at_y).seen;
    const double share = static_cast<double>(step) / walk.length();
    for (std::uint32_t rest = seen == 0 ? 0 : suspicious; rest != 0; rest &= rest - 1) {
      const int slice = std::countr_zero(rest);
      const double on_ray =
          slice_on_ray(parameters, lattice, window, at_x, at_y, to_foot, slice, share);
      if (on_ray < 0.0 || on_ray > kTopSlice) continue;
      if ((seen >> static_cast<int>(on_ray) & 1) != 0) hidden |= std::uint32_t{1} << slice;
    }
    if (std::abs(step - walk.length()) <= 1) break;
  }
  return hidden;
}

/// Step 8: the parts above the ground of a slice. Bit i is part i.
std::uint32_t parts_above_ground(const Lattice& lattice, const Column& column, int slice) {
  if (slice < 0 || slice > column.last_slice || (column.occupied >> slice & 1) == 0) return 0;
  const auto first = static_cast<std::size_t>(slice) * static_cast<std::size_t>(lattice.parts);
  double all = 0.0;
  for (int part = 0; part < lattice.parts; ++part) {
    all += column.points[first + static_cast<std::size_t>(part)];
  }
  std::uint32_t above = 0;
  double below = 0.0;
  int empty = 0;
  bool is_above = false, has_begun = false;
  for (int part = 0; part < lattice.parts; ++part) {
    const std::uint32_t points = column.points[first + static_cast<std::size_t>(part)];
    if (points == 0) {
      if (++empty >= 2 && has_begun) break;  // As between slices.
      continue;
    }
    empty = 0;
    has_begun = true;
    if (is_above) above |= std::uint32_t{1} << part;
    below += points;
    is_above = is_above || below >= kGroundShare * all;
  }
  return above;
}

}  // namespace

Marks judge(const Parameters& parameters, const ColumnMap& map, const Scan& scan,
            const std::vector<PlacedPoint>& placed) {
  Marks marks;
  const ScanWindow window(parameters, map, scan, placed);
  if (window.is_empty()) return marks;
  const Lattice& lattice = map.lattice();
  for (int x = 0; x < window.side(); ++x) {
    for (int y = 0; y < window.side(); ++y) {
      std::uint32_t slices = suspicious_slices(parameters, map, window, x, y);
      if (slices == 0) continue;
      slices &= ~hidden_slices(parameters, lattice, window, x, y, slices);
      if (slices == 0) continue;
      const std::uint32_t column = window.at(x, y).column;
      marks.slices.push_back({column, slices});
      const int ground = std::countr_zero(slices) - 1;
      const std::uint32_t parts = parts_above_ground(lattice, map.columns()[column], ground);
      if (parts != 0) marks.parts.push_back({column, ground, parts});
    }
  }
  return marks;
}

void add_marks(const Marks& marks, ColumnMap& map) {
  for (const Marks::Slices& mark : marks.slices) {
    map.columns()[mark.column].removed |= mark.slices;
  }
  for (const Marks::Parts& mark : marks.parts) {
    std::vector<std::uint32_t>& parts = map.columns()[mark.column].removed_parts;
    const auto slice = static_cast<std::size_t>(mark.slice);
    if (parts.size() <= slice) parts.resize(slice + 1);
    parts[slice] |= mark.parts;
  }
}

}  // namespace raymoval::beautymap_method
