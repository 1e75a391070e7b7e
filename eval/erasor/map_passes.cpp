// SPDX-License-Identifier: MIT
#include "eval/erasor/map_passes.h"

#include <algorithm>
#include <cmath>

#include "eval/checked_scan.h"

namespace raymoval::erasor {
namespace {

/// How near to a cell's wall a mean may be put on the other side by rounding, metres. It is far
/// more than rounding does anywhere on the lattice.
constexpr double kWallMargin = 1e-6;

/// Adds the cell of a point, and those into which a mean of such points may be rounded.
void insert_cells(const Eigen::Vector3d& point, double inverse, CellSet& cells) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kWallMargin);
  const VoxelIndex low = voxel_index(point - margin, inverse);
  const VoxelIndex high = voxel_index(point + margin, inverse);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) cells.insert(voxel_key(x, y, z));
    }
  }
}

/// The cells of `lattice` that are at most `steps` cells from one of `centres` along each axis.
CellLattice cells_around(const CellSet& centres, int steps, const CellLattice& lattice) {
  CellSet around;
  CellLattice::Cursor cursor;
  centres.for_each([&](VoxelKey centre) {
    for (int z = -steps; z <= steps; ++z) {
      for (int y = -steps; y <= steps; ++y) {
        for (int x = -steps; x <= steps; ++x) {
          const VoxelKey cell = cell_beside(centre, x, y, z);
          if (lattice.contains(cell, cursor)) around.insert(cell);
        }
      }
    }
  });
  return CellLattice(around);
}

/// Any label word that says static, for voxels that can have no other class.
std::uint32_t static_word(const LabelClasses& classes) {
  for (std::uint32_t id = 0; id <= 0xFFFF; ++id) {
    if (id != kMovingTruck && classes.of(id) == LabelClass::kStatic) return id;
  }
  return 0;
}

bool is_empty(const Eigen::Vector3d& mean) {
  return std::isnan(mean.x());
}

}  // namespace

bool MapCellsPass::begin_pass(std::size_t slots) {
  const bool is_first = slots_.empty();
  slots_.resize(slots);
  return is_first;
}

void MapCellsPass::read(const CheckedScan& scan, std::size_t slot) {
  Part& part = slots_[slot];
  part.cells.clear();
  part.moving.clear();
  const double inverse = 1.0 / rules_.options.voxel_size;
  const LabelledCloud cloud = place_scan(scan, rules_.input, rules_.options, rules_.classes).cloud;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    insert_cells(cloud.points[i], inverse, part.cells);
    const std::uint32_t word = cloud.labels[i];
    if (!rules_.classes.moving(word) && semantic_id(word) != kMovingTruck) continue;
    part.moving.insert(voxel_key(voxel_index(cloud.points[i], inverse)));
  }
}

void MapCellsPass::take(std::size_t slot) {
  all_.cells.insert(slots_[slot].cells);
  all_.moving.insert(slots_[slot].moving);
}

MapCells MapCellsPass::cells() const {
  MapCells cells;
  cells.all = CellLattice(all_.cells);
  cells.sorted = cells.all.sorted();
  cells.mixed = cells_around(all_.moving, 2, cells.all);
  cells.near_mixed = cells_around(all_.moving, 3, cells.all);
  CellLattice::Cursor cursor;
  cells.mixed.for_each([&](CellLattice::Number, VoxelKey cell) {
    cells.mixed_numbers.push_back(cells.all.find(cell, cursor));
  });
  return cells;
}

MapPasses::MapPasses(const MapRules& rules, const MapCells& cells, Labels labels)
    : rules_(rules), cells_(cells), labels_(labels) {}

bool MapPasses::begin_pass(std::size_t slots) {
  slots_.resize(slots);
  switch (++pass_) {
    case 1:
      sums_.resize(cells_.all.size());
      return true;
    case 2:
      end_sums();
      votes_ = std::make_unique<LabelVotes>(voters().size());
      return voters().size() > 0;
    default:
      return false;
  }
}

void MapPasses::read(const CheckedScan& scan, std::size_t slot) {
  Part& part = slots_[slot];
  part.scan = static_cast<std::uint32_t>(scan.scan.index);
  const PlacedScan placed = place_scan(scan, rules_.input, rules_.options, rules_.classes);
  part.points = placed.points;
  if (pass_ == 1) {
    read_means(placed, part);
  } else {
    read_offers(placed, part);
  }
}

void MapPasses::take(std::size_t slot) {
  const Part& part = slots_[slot];
  if (pass_ == 1) {
    points_ += part.points;
    for (const auto& [number, mean] : part.means) sums_[number].add(mean);
    return;
  }
  ties_ += part.ties;
  for (const Offer& offer : part.offers) {
    votes_->offer(offer.voter, offer.distance, {offer.word, part.scan}, offer.moves);
  }
}

/// The points that the scan adds to the dense map, and the cell of each.
void MapPasses::read_means(const PlacedScan& placed, Part& part) const {
  struct Mean {
    VoxelKey from;  ///< Cell of the points of which it is the mean.
    Number to;      ///< Cell in which it lies; by rounding this may be the next one.
    Eigen::Vector3d point;
  };
  const double inverse = 1.0 / rules_.options.voxel_size;
  part.cells.compute(placed.cloud.points, rules_.options.voxel_size);
  std::vector<Mean> means;
  means.reserve(part.cells.cells().size());
  CellLattice::Cursor cursor;
  bool in_own_cells = true;
  for (const CellMeans::Cell& cell : part.cells.cells()) {
    const Eigen::Vector3d point = cell.mean.mean();
    const VoxelKey key = voxel_key(voxel_index(point, inverse));
    const Number number = cells_.all.find(key, cursor);
    if (number == CellLattice::kNone) throw_changed(rules_.input, part.scan);
    in_own_cells = in_own_cells && key == cell.key;
    means.push_back({cell.key, number, point});
  }
  // In the order of the dense map. It only matters where a cell gets more than one.
  if (!in_own_cells) {
    std::sort(means.begin(), means.end(),
              [](const Mean& a, const Mean& b) { return a.from < b.from; });
  }
  part.means.clear();
  for (const Mean& mean : means) part.means.emplace_back(mean.to, mean.point);
}

/// The votes of the points that the scan adds to the dense map.
void MapPasses::read_offers(const PlacedScan& placed, Part& part) const {
  LabelledCloud selected;
  const LabelledCloud* cloud = &placed.cloud;
  if (labels_ == Labels::kClasses) {
    const double inverse = 1.0 / rules_.options.voxel_size;
    CellLattice::Cursor cursor;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      const VoxelKey key = voxel_key(voxel_index(cloud->points[i], inverse));
      if (!cells_.near_mixed.contains(key, cursor)) continue;
      selected.points.push_back(cloud->points[i]);
      selected.labels.push_back(cloud->labels[i]);
    }
    cloud = &selected;
  }
  const LabelledVoxels dense = voxelise(*cloud, rules_.options.voxel_size, rules_.classes, 1);
  part.ties = dense.mixed_label_ties;
  part.offers.clear();
  CellLattice::Cursor cursor;
  for (std::size_t i = 0; i < dense.size(); ++i) {
    offer_around(dense.cloud.points[i], dense.cloud.labels[i], cursor, part);
  }
}

/// Offers a point of the dense map to the voxels in reach. A voxel's nearest point is never farther
/// from its mean than half a diagonal.
void MapPasses::offer_around(const Eigen::Vector3d& point, std::uint32_t word,
                             CellLattice::Cursor& cursor, Part& part) const {
  const double size = rules_.options.voxel_size;
  const double bound = std::pow(std::sqrt(0.75) * size + kWallMargin, 2);
  const VoxelIndex index = voxel_index(point, 1.0 / size);
  const VoxelKey cell = voxel_key(index);
  // Squared distances to the cells below, to the own one and to those above, along each axis.
  Eigen::Matrix3d gaps = Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const double below = std::max(0.0, point[axis] - index[axis] * size - kWallMargin);
    const double above = std::max(0.0, (index[axis] + 1) * size - point[axis] - kWallMargin);
    gaps(axis, 0) = below * below;
    gaps(axis, 2) = above * above;
  }
  const bool moves = rules_.classes.moving(word);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (gaps(0, x + 1) + gaps(1, y + 1) + gaps(2, z + 1) > bound) continue;
        const std::uint32_t voter = voters().find(cell_beside(cell, x, y, z), cursor);
        if (voter == CellLattice::kNone) continue;
        const double squared = (point - means_[number_of(voter)]).squaredNorm();
        if (squared <= bound) part.offers.push_back({voter, word, std::sqrt(squared), moves});
      }
    }
  }
}

void MapPasses::end_sums() {
  means_.reserve(sums_.size());
  for (const OffsetMean& sum : sums_) means_.push_back(sum.mean());
  sums_ = {};
}

LabelledVoxels MapPasses::finish(std::vector<std::uint32_t>* scan_of_voxel) {
  const std::uint32_t any_static = static_word(rules_.classes);
  LabelledVoxels map;
  map.mixed_label_ties = ties_;
  CellLattice::Cursor cursor;
  for (const CellPoint& cell : cells_.sorted) {
    const Eigen::Vector3d& mean = means_[cell.point];
    if (is_empty(mean)) continue;
    LabelVotes::Label label{any_static, 0};
    const std::uint32_t voter =
        labels_ == Labels::kExact ? cell.point : cells_.mixed.find(cell.key, cursor);
    if (voter != CellLattice::kNone) {
      label = votes_->label(voter);
      map.mixed_label_ties += votes_->is_mixed_tie(voter) ? 1 : 0;
    }
    map.keys.push_back(cell.key);
    map.cloud.points.push_back(mean);
    map.cloud.labels.push_back(label.word);
    if (scan_of_voxel != nullptr) scan_of_voxel->push_back(label.scan);
  }
  return map;
}

}  // namespace raymoval::erasor
