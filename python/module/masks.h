// SPDX-License-Identifier: MIT
#pragma once

#include "core/scan/mask_store.h"
#include "python/module/sequences.h"

namespace raymoval::python {

/// An answer for Python: a mask for each scan, made on request.
struct HeldMasks {
  MaskStore masks;     ///< Of the points that the method got.
  MaskStore left_out;  ///< Of arrays: the rows that no method gets. Empty otherwise.

  /// As long as the array of the scan has rows; rows without a return are not removed.
  [[nodiscard]] Mask mask(std::size_t scan) const;
};

/// The masks for `sequence` that `given` holds: a HeldMasks, or anything with a mask for each scan,
/// as long as the scan's array has rows.
/// @throws UsageError, MethodError for masks that do not fit
/// @note To be called with the GIL.
MaskStore masks_from(const py::object& given, const HeldSequence& sequence);

}  // namespace raymoval::python
