// SPDX-License-Identifier: MIT
#pragma once

#include <bitset>
#include <filesystem>
#include <functional>
#include <string>

#include "core/scan/label_rule.h"
#include "core/scan/mask_store.h"
#include "core/scan/scan_source.h"

namespace raymoval {

/// Semantic ids of a prediction: `kRemovedLabel` to `kLastRemovedLabel` mean removed, others kept.
inline constexpr std::uint16_t kRemovedLabel = 251;
inline constexpr std::uint16_t kLastRemovedLabel = 259;
inline constexpr std::uint16_t kKeptLabel = 9;
/// Neither kept nor removed: missing returns, the ego vehicle (--drop-ego), and points beyond the
/// --range of `raymoval clean`. When read back, it counts as kept; it is never scored.
inline constexpr std::uint16_t kLeftOutLabel = 0;
/// Mask value of a point that is neither kept nor removed; methods never use it.
inline constexpr std::uint8_t kLeftOutMask = 2;

/// Writes the file `<scan name>.label` of one scan into `folder`, which exists; see
/// `write_removals`.
void write_removal(const std::filesystem::path& folder, const Scan& scan, const Mask& mask);

/// Writes a file `<scan name>.label` per scan into `folder` (made if missing): one 32-bit
/// little-endian word per point of the scan's file; 251 = removed, 9 = kept, 0 = left out.
/// @param after_scan called after each written scan; may throw to stop
void write_removals(const std::filesystem::path& folder, const ScanSource& scans,
                    const MaskStore& masks, const std::function<void()>& after_scan);

/// Removes a folder of removals (and of reasons, see benchmark/result/removals/reasons.h) with all
/// files that a run writes there. Of a link, only the link is removed. A missing folder is no
/// error.
/// @return false, without removing anything, if the folder has other content
bool remove_removals(const std::filesystem::path& folder);

/// Whether `remove_removals` can remove the whole folder, or the folder is missing.
/// @throws DataError if it cannot be read
bool can_remove_removals(const std::filesystem::path& folder);

/// A set of semantic ids.
using LabelIds = std::bitset<65536>;

/// Reads the label files of `write_removals` or of another program: 251 to 259 = removed.
/// @throws DataError naming the file that is missing or does not have one label per point of its
/// scan
MaskStore read_removals(const std::filesystem::path& folder, const ScanSource& scans,
                        const std::function<void()>& after_scan);

/// The semantic ids in the files of predictions, and whether some files are arrays.
struct PredictedIds {
  LabelIds ids;
  bool arrays = false;
};

/// The predictions of another program.
struct Predictions {
  MaskStore masks;
  PredictedIds found;
  std::string note;  ///< How the ids were read, if none is from 251 to 259; else empty.
};

/// Reads the predictions of another program: a file NAME.label or an array NAME.npy for each scan
/// (bool, whole numbers, or shares, of which 0.5 and more mean removed). If no label is from 251 to
/// 259, removed are the ids that move by `rule`, else 2 among learning ids (0, 1, 2), else 1 in
/// arrays of 0 and 1.
/// @throws DataError as `read_removals`
Predictions read_predictions(const std::filesystem::path& folder, const ScanSource& scans,
                             const LabelRule& rule, const std::function<void()>& after_scan);

/// The folder with the files of `sequence`: `folder`, or sequences/NN/predictions in it, as in MOS
/// benchmarks.
/// @throws DataError if there are several and none is that of `sequence`
std::filesystem::path prediction_folder(const std::filesystem::path& folder,
                                        const std::string& sequence);

/// "0, 1", the smallest of `ids`, and how many more there are.
std::string label_ids_text(const LabelIds& ids);

}  // namespace raymoval
