// SPDX-License-Identifier: MIT
// Dynablox written straight from its eight steps with a record for every voxel: slow and plain.
// The arc tangent has the method's own operations, since its last digits decide beside thresholds.
#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "core/scan/scan_source.h"
#include "methods/dynablox/field.h"

namespace raymoval::dynablox_test {

using namespace dynablox_method;

using Cell = std::array<int, 3>;  ///< z, y, x, so that sorted cells run along x first.

struct Voxel {
  float distance = 0.0F;
  float weight = 0.0F;
  int occupied_scans = 0;
  int last_occupied = -1;
  bool ever_free = false;
};

/// atan2(y, x) as the kernels find it.
float arc_tangent(float y, float x);

class Oracle {
 public:
  Oracle(const Parameters& parameters, const SensorModel& sensor);

  [[nodiscard]] std::vector<Mask> masks(const ScanSource& scans);
  [[nodiscard]] int ever_free_count() const;

 private:
  using Block = std::map<Cell, Voxel>;
  using Cluster = std::set<Cell>;

  [[nodiscard]] Cell cell_of(const Scan& scan, std::size_t point) const;
  [[nodiscard]] const Voxel* find(const Cell& cell) const;
  Voxel* find(const Cell& cell);

  [[nodiscard]] Mask judge(const Scan& scan) const;
  [[nodiscard]] std::vector<Cluster> grow(const std::set<Cell>& hit) const;
  void merge(std::vector<Cluster>& clusters) const;
  [[nodiscard]] bool are_near(const Cluster& a, const Cluster& b) const;
  void update_free_space(const Scan& scan);
  void become_ever_free(const Cell& cell, Voxel& voxel, int now);
  void integrate(const Scan& scan);
  void touch(const Scan& scan);
  void update(const Scan& scan, const std::vector<float>& image, const Cell& cell, Voxel& voxel);
  [[nodiscard]] std::vector<float> image_of(const Scan& scan) const;
  /// The range of a pixel, 0 outside the image and where there is no return.
  [[nodiscard]] float pixel(const std::vector<float>& image, int column, int row) const;
  [[nodiscard]] float adaptive_range(const std::vector<float>& image, float u, float v) const;
  [[nodiscard]] float weight_of_scan(float square, float ahead) const;

  Parameters parameters_;
  ImageGrid grid_;
  double max_range_;
  std::map<Cell, Block> blocks_;
  std::set<Cell> touched_;
};

}  // namespace raymoval::dynablox_test
