// SPDX-License-Identifier: MIT
#pragma once

#include <bitset>
#include <filesystem>
#include <functional>
#include <string>

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
/// @param found gets the semantic ids of all points of the scans; null: nobody asks
/// @throws DataError naming the file that is missing or has another count than its scan
MaskStore read_removals(const std::filesystem::path& folder, const ScanSource& scans,
                        const std::function<void()>& after_scan, LabelIds* found = nullptr);

/// Whether one of `ids` means removed.
bool has_removed_label(const LabelIds& ids);

/// "0, 1", the smallest of `ids`, and how many more there are.
std::string label_ids_text(const LabelIds& ids);

}  // namespace raymoval
