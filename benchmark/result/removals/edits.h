// SPDX-License-Identifier: MIT
#pragma once

#include <tsl/robin_set.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/scan/mask_store.h"
#include "core/scan/scan_source.h"

namespace raymoval {

/// The edge of the voxels that a page shows and thins points by, metres. The `erasor` protocol uses
/// the same.
inline constexpr double kPageVoxel = 0.2;

/// The number of steps along the edge of a voxel. Positions in pages and in edits are whole numbers
/// of steps.
inline constexpr int kStepsPerVoxel = 16;

/// A position in steps, or a cell as its position divided by the cell's edge and rounded down.
using MapSteps = std::array<std::int32_t, 3>;

/// The position of a point in steps. It is always within the voxel of `voxel_index`, despite
/// rounding.
/// @param upright position in the frame of the scans, turned so that up is z; metres
/// @throws DataError beyond what 32 bits hold
MapSteps map_steps(const Eigen::Vector3d& upright);

/// The cell of a position. @param edge of the cell in steps, at least 1
MapSteps map_cell(const MapSteps& steps, int edge);

/// The removals of one scan at the time of a review.
struct ReviewedScan {
  std::string name;
  std::uint64_t points = 0;         ///< Points that the method got.
  std::string digest;               ///< Of pose and points, 16 hexadecimal digits.
  std::vector<std::uint64_t> runs;  ///< First point and number of points of each removed run.
};

/// @param mask 1 = removed
ReviewedScan reviewed_scan(const Scan& scan, const Mask& mask);

/// A method's answer, and the corrections of a reviewer (edits.json). The page of `raymoval clean
/// --html` exports it.
struct Edits {
  std::string sequence, method;
  Eigen::Matrix3d R_upright_world = Eigen::Matrix3d::Identity();
  int removed_cell = kStepsPerVoxel;  ///< Edge of the cells of `keep`, in steps.
  int kept_cell = kStepsPerVoxel;     ///< Edge of the cells of `remove`, in steps.
  std::vector<ReviewedScan> scans;

  using ScanCell = std::array<std::int32_t, 4>;  ///< Index of a scan, or -1; cell x, y, z.
  struct CellHash {
    std::size_t operator()(const ScanCell& cell) const;
  };
  using Cells = tsl::robin_set<ScanCell, CellHash>;
  Cells keep;    ///< Removed points of this scan in this cell are kept.
  Cells remove;  ///< Kept points in this cell are removed from all scans (index -1).
};

/// `edits` without corrections, for a page.
nlohmann::ordered_json to_json(const Edits& edits);

/// @throws ConfigurationError if the file has not the form of edits
Edits read_edits(const std::filesystem::path& path);

/// The corrected masks, and how many points each kind of correction changed.
struct EditedMasks {
  MaskStore masks;
  std::uint64_t kept = 0, removed = 0;
  std::size_t changed_scans = 0;  ///< Scans with another pose or other points than at the review.
};

/// Applies edits to the scans that were reviewed.
/// @param where the file's path, for messages
/// @param force applies them also to scans with another digest, if the number of points fits
/// @param after_scan called after each scan; may throw to stop
/// @throws DataError if the scans are not those that were reviewed
EditedMasks apply_edits(const Edits& edits, const ScanSource& scans, const std::string& where,
                        bool force, const std::function<void()>& after_scan);

/// Corrected masks as the truth: 251 = removed, 9 = kept.
std::shared_ptr<const LabelSource> labels_of_masks(MaskStore masks);

}  // namespace raymoval
