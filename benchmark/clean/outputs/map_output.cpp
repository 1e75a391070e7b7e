// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/map_output.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "benchmark/result/removals/removal_files.h"
#include "core/text.h"

namespace raymoval {
RecordLayout labelled_layout(const RecordLayout& layout) {
  return layout_with_field(layout, "label", 'U', sizeof(std::uint16_t));
}

MapOutput::MapOutput(const std::filesystem::path& path, const RecordLayout& layout,
                     MapContent content, double voxel_size, const Eigen::Vector3d& voxel_origin)
    : file_(path),
      layout_(content.labelled ? labelled_layout(layout) : layout),
      labelled_(content.labelled),
      has_cells_(voxel_size > 0.0) {
  file_.start(layout_);
  const auto add_side = [&](std::uint8_t mask) {
    sides_.push_back({mask, has_cells_
                                ? std::make_unique<VoxelRows>(layout, voxel_size, voxel_origin)
                                : nullptr});
  };
  if (content.kept) add_side(0);
  if (content.removed) add_side(1);
}

ScanRows MapOutput::with_label(const ScanRows& rows,
                               const std::vector<std::uint8_t>& removed) const {
  return rows_with_field(rows, layout_, [&](std::size_t i) -> std::uint16_t {
    return removed[i] != 0 ? kRemovedLabel : kKeptLabel;
  });
}

void MapOutput::write(const ScanRows& rows) {
  points_ += rows.rows.size();
  file_.add(rows.rows);
}

void MapOutput::pass_on(const CleanedScan& scan) {
  const auto is_chosen = [this](std::uint8_t mask) {
    return std::any_of(sides_.begin(), sides_.end(),
                       [mask](const Side& side) { return side.mask == mask; });
  };
  const std::array<std::uint8_t, 2> sides = {is_chosen(0), is_chosen(1)};
  std::vector<std::uint8_t> chosen(scan.mask.size());
  std::transform(scan.mask.begin(), scan.mask.end(), chosen.begin(),
                 [&](std::uint8_t mask) { return mask > 1 ? std::uint8_t{0} : sides[mask]; });
  const auto count = std::count(chosen.begin(), chosen.end(), 1);
  if (count == 0) return;
  if (!labelled_ && static_cast<std::size_t>(count) == chosen.size()) return write(scan.rows);
  ScanRows rows{scan.rows.rows.chosen(chosen), {}};
  std::vector<std::uint8_t> removed;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] == 0) continue;
    if (labelled_) removed.push_back(scan.mask[i]);
  }
  write(labelled_ ? with_label(rows, removed) : rows);
}

void MapOutput::add(const CleanedScan& scan) {
  if (!has_cells_) return pass_on(scan);
  for (const Side& side : sides_) {
    for (std::size_t i = 0; i < scan.mask.size(); ++i) {
      if (scan.mask[i] == side.mask) side.cells->add(scan.rows, i);
    }
  }
}

void MapOutput::finish() {
  for (const Side& side : sides_) {
    if (!has_cells_) break;
    side.cells->take([&](const ScanRows& piece) {
      const std::vector<std::uint8_t> removed(piece.world.size(), side.mask);
      write(labelled_ ? with_label(piece, removed) : piece);
    });
  }
  file_.finish();
}

}  // namespace raymoval
