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
/// Neither kept nor removed: missing returns, the own vehicle (--drop-ego), and what is beyond the
/// --range of `raymoval clean`. Read back it counts as kept, and is never scored.
inline constexpr std::uint16_t kLeftOutLabel = 0;
/// Value of a mask for a point that is neither kept nor removed; methods never give it.
inline constexpr std::uint8_t kLeftOutMask = 2;

/// Writes the file `<scan name>.label` of one scan into `folder`, which is there; see
/// `write_removals`.
void write_removal(const std::filesystem::path& folder, const Scan& scan, const Mask& mask);

/// Writes a file `<scan name>.label` per scan into `folder` (made if missing): one 32-bit
/// little-endian word per point of the scan's file; 251 = removed, 9 = kept, 0 = left out.
/// @param after_scan called once a scan is written; may throw to stop
void write_removals(const std::filesystem::path& folder, const ScanSource& scans,
                    const MaskStore& masks, const std::function<void()>& after_scan);

/// Removes a folder of removals (and of reasons, see benchmark/result/removals/reasons.h) with all
/// files that a run writes there. A link to such a folder goes alone; one that is not there is no
/// error.
/// @return false if it holds anything else; then all of it stays
bool remove_removals(const std::filesystem::path& folder);

/// Whether `remove_removals` can remove all of the folder, or there is nothing to remove.
/// @throws DataError if it cannot be looked at
bool can_remove_removals(const std::filesystem::path& folder);

/// Which semantic ids occur.
using LabelIds = std::bitset<65536>;

/// Reads what `write_removals` or another program wrote: 251 to 259 = removed.
/// @throws DataError naming the file that is missing or has another count than its scan
MaskStore read_removals(const std::filesystem::path& folder, const ScanSource& scans,
                        const std::function<void()>& after_scan);

/// The semantic ids in the files of an answer, and whether there are arrays among these.
struct PredictedIds {
  LabelIds ids;
  bool arrays = false;
};

/// The answer of another program.
struct Predictions {
  MaskStore masks;
  PredictedIds found;
  std::string note;  ///< How the ids were read, if none is from 251 to 259; else empty.
};

/// Reads the answer of another program: a file NAME.label or an array NAME.npy for each scan
/// (bool, whole numbers, or shares, of which 0.5 and more mean removed). Without a label from 251
/// to 259 the ids that move by `rule` mean removed, else 2 among learning ids (0, 1, 2), else 1
/// among arrays of 0 and 1.
/// @throws DataError as `read_removals`
Predictions read_predictions(const std::filesystem::path& folder, const ScanSource& scans,
                             const LabelRule& rule, const std::function<void()>& after_scan);

/// The folder with the files of `sequence`: `folder`, or sequences/NN/predictions in it, where MOS
/// benchmarks have them. @throws DataError if none of several is that of `sequence`
std::filesystem::path prediction_folder(const std::filesystem::path& folder,
                                        const std::string& sequence);

/// "0, 1", the smallest of `ids`, and how many more there are.
std::string label_ids_text(const LabelIds& ids);

}  // namespace raymoval
