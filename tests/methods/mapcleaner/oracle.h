// SPDX-License-Identifier: MIT
// MapCleaner written straight from its description with lists, sorted points and a plain array of
// cells: slow and plain.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/scan/scan_source.h"
#include "methods/mapcleaner/parameters.h"

namespace raymoval::mapcleaner_test {

using mapcleaner_method::Parameters;

/// Patchwork++ on one scan after the other.
class GroundOracle {
 public:
  explicit GroundOracle(const Parameters& parameters);
  Mask ground(const Scan& scan);

 private:
  struct Bin {
    int zone = 0, ring = 0;
    std::vector<std::size_t> points;
    std::vector<std::size_t> ground;
    bool has_plane = false;
    Eigen::Vector3d mean, normal, spread;  ///< Spread descending, of the sample.
    double offset = 0.0;
  };
  std::map<int, Bin> bins(const Scan& scan);
  void fit(Bin& bin) const;
  void plane_of(const std::vector<std::size_t>& chosen, Bin& bin) const;
  [[nodiscard]] std::vector<std::size_t> seeds(const Bin& bin, const std::vector<std::size_t>& left,
                                               double above) const;
  void learn_height(std::map<int, Bin>& bins);
  void judge(int ring, std::map<int, Bin>& bins);
  void adapt();

  Parameters p_;
  double height_;
  bool knows_height_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> elevations_[4], flatnesses_[4];
  double low_[4] = {0, 0, 0, 0}, flat_[4] = {0, 0, 0, 0};
};

class Oracle {
 public:
  Oracle(const Parameters& parameters, const ScanSource& scans);
  [[nodiscard]] Mask mask(std::size_t i) const;
  [[nodiscard]] double terrain(int x, int y) const { return at(terrain_, x, y); }

 private:
  /// Cells -kHalf .. kHalf - 1 along x and y.
  static constexpr int kHalf = 66;
  using Cells = std::vector<double>;
  using Voxel = std::vector<int>;

  [[nodiscard]] static double at(const Cells& cells, int x, int y);
  static double& put(Cells& cells, int x, int y);
  [[nodiscard]] int cell(double c) const;
  [[nodiscard]] Voxel voxel(const Eigen::Vector3d& world) const;
  void measure();
  [[nodiscard]] Cells filled(const Cells& cells, double radius, double deviation) const;
  [[nodiscard]] std::pair<double, double> gradient(const Cells& cells, int x, int y) const;
  /// @param lean the gradient from which slopes count
  [[nodiscard]] bool is_passable(const Cells& cells, int x, int y,
                                 const std::pair<double, double>& lean) const;
  /// The median gradient around a cell.
  [[nodiscard]] std::pair<double, double> lean(const Cells& cells, int x, int y,
                                               double radius) const;
  void reach(const Cells& cells, int x, int y, const std::pair<double, double>& lean,
             Cells& kept) const;
  [[nodiscard]] Cells reached(const Cells& cells) const;
  static Cells smoothed(const Cells& cells);
  /// 'g'round, 'b'elow, 'c'andidate, 'o'ther.
  [[nodiscard]] char part(std::size_t scan, std::size_t point) const;
  [[nodiscard]] Eigen::Vector3d world(std::size_t scan, std::size_t point) const {
    return scans_[scan].T_world_sensor * scans_[scan].points[point].cast<double>();
  }
  void vote();
  [[nodiscard]] std::pair<int, int> pixel(const Eigen::Vector3d& point) const;
  /// +1 for seen through, -1 for seen.
  [[nodiscard]] int look(const std::map<std::pair<int, int>, double>& image,
                         const Eigen::Vector3d& point) const;

  Parameters p_;
  SensorModel sensor_;
  std::vector<Scan> scans_;
  std::vector<Mask> grounds_;
  Cells terrain_;
  std::map<Voxel, int> votes_;
  // Of the image.
  double row_height_ = 0.0, column_width_ = 0.0, low_ = 0.0, left_ = 0.0;
  int rows_ = 0, columns_ = 0;
  bool is_circle_ = true;
};

}  // namespace raymoval::mapcleaner_test
