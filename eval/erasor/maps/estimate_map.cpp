// SPDX-License-Identifier: MIT
#include "eval/erasor/maps/estimate_map.h"

#include <utility>

#include "eval/checked_scan.h"

namespace raymoval::erasor {
EstimateMap::EstimateMap(const MapRules& rules, const TruthMap& truth)
    : rules_(rules), truth_(truth), points_(truth.points()), touched_(truth.cells().size()) {}

bool EstimateMap::begin_pass(std::size_t slots) {
  slots_.resize(slots);
  switch (++pass_) {
    case kTouch:
      return true;
    case kAddUp:
      if (points_.removed == 0) mixed_label_ties_ = truth_.mixed_label_ties();
      if (points_.removed == 0 || is_empty()) return false;
      touched_.count_through();
      means_ = MeanTable(touched_.count());
      places_ = places_of(touched_);
      return true;
    case kVote:
      return begin_votes();
    default:
      for (std::size_t i = 0; votes_ && i < truth_.map_cells().mixed.count(); ++i) {
        mixed_label_ties_ += votes_->is_mixed_tie(i) ? 1 : 0;
      }
      return false;
  }
}

void EstimateMap::read(const CheckedScan& scan, std::size_t slot) {
  Part& part = slots_[slot];
  part.scan = static_cast<std::uint32_t>(scan.scan.index);
  if (pass_ == kTouch) {
    touch(scan, part);
  } else if (pass_ == kAddUp) {
    add_up(scan, part);
  } else {
    vote(scan, part);
  }
}

void EstimateMap::take(std::size_t slot) {
  const Part& part = slots_[slot];
  if (pass_ == kTouch) {
    points_.removed += part.removed;
  } else if (pass_ == kAddUp) {
    for (const DensePoint& point : part.dense) {
      means_.add(touched_.rank(point.cell), point.point);
    }
  } else {
    mixed_label_ties_ += part.ties;
    for (const Offer& offer : part.offers) {
      votes_->offer(offer.voter, offer.distance, {semantic_id(offer.word), part.scan}, offer.moves);
    }
  }
}

VoxelKind EstimateMap::kind(Number number) const {
  if (!is_voxel(mean(number))) return VoxelKind::kNone;
  if (points_.removed == 0) return truth_.kind(number);
  const RankedBits& mixed = truth_.map_cells().mixed;
  if (!mixed.test(number)) return VoxelKind::kStatic;
  return kind_of(votes_->label(mixed.rank(number)).id, rules_.classes);
}

/// Touches the cells of removed points.
void EstimateMap::touch(const CheckedScan& scan, Part& part) {
  const double inverse = 1.0 / rules_.options.voxel_size;
  CellLattice::Cursor cursor;
  part.removed = 0;
  visit_placed(scan, rules_, true, [&](const Eigen::Vector3d& point, std::uint32_t) {
    ++part.removed;
    const Number number = cells().find(cell_key(point, inverse), cursor);
    if (number == CellLattice::kNone) throw_changed(rules_.input, part.scan);
    touched_.set(number);
  });
}

void EstimateMap::add_up(const CheckedScan& scan, Part& part) const {
  const LabelledCloud cloud = points_in(scan, touched_);
  part.dense = dense_points(cloud.points, rules_, truth_.map_cells(), part.scan, part.means);
}

bool EstimateMap::begin_votes() {
  (void)means_.finish();
  votes_ = std::make_unique<LabelVotes>(truth_.map_cells().mixed.count());
  if (truth_.map_cells().mixed.count() == 0) return false;
  places_ = places_of(truth_.map_cells().near_mixed);
  return true;
}

void EstimateMap::vote(const CheckedScan& scan, Part& part) const {
  const RankedBits& mixed = truth_.map_cells().mixed;
  const LabelledVoxels dense = voxelise(points_in(scan, truth_.map_cells().near_mixed),
                                        rules_.options.voxel_size, rules_.classes, 1);
  part.ties = dense.mixed_label_ties;
  part.offers.clear();
  add_offers(
      dense.cloud, rules_, cells(),
      [&](Number number) { return mixed.test(number) ? mixed.rank(number) : CellLattice::kNone; },
      [&](Number number) { return mean(number); }, part.offers);
}

/// The places of the cells whose bits are set. Most points of a scan are elsewhere.
CoarseCells EstimateMap::places_of(const RankedBits& wanted) const {
  return {1.0 / rules_.options.voxel_size, [&](const auto& visit) {
            cells().for_each([&](Number number, VoxelKey cell) {
              if (wanted.test(number)) visit(voxel_index(cell));
            });
          }};
}

/// The kept points of a scan in the `wanted` cells, all of which are in `places_`.
LabelledCloud EstimateMap::points_in(const CheckedScan& scan, const RankedBits& wanted) const {
  const double inverse = 1.0 / rules_.options.voxel_size;
  LabelledCloud cloud;
  CellLattice::Cursor cursor;
  visit_placed_where(
      scan, rules_, false, [&](const Eigen::Vector3d& point) { return places_.may_hold(point); },
      [&](const Eigen::Vector3d& point, std::uint32_t word) {
        const Number number = cells().find(cell_key(point, inverse), cursor);
        if (number == CellLattice::kNone) throw_changed(rules_.input, scan.scan.index);
        if (!wanted.test(number)) return;
        cloud.points.push_back(point);
        cloud.labels.push_back(word);
      });
  return cloud;
}

}  // namespace raymoval::erasor
