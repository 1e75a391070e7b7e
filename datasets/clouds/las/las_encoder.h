// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// Writes LAS 1.4: point format 6, with colours 7, with near infrared 8.
///
/// A field whose name and type LAS has goes where LAS has it (a smaller whole type also); every
/// other one becomes a field of the extra bytes. Besides, real intensities are written rounded (see
/// `RecordWriting::intensity_scale`) where viewers look, and colours that are packed in one number
/// likewise. Coordinates are whole multiples of a scale from an offset: those of the LAS file that
/// the first points come from, else 0.001 m and a place near the first points. The reference system
/// is WKT, as points of these formats demand.
/// @throws UsageError for a reference system that cannot be written
std::unique_ptr<RecordEncoder> las_encoder(const std::filesystem::path& path,
                                           const RecordWriting& writing);

/// As `shown_intensity`.
std::optional<ShownIntensity> shown_in_las(const RecordLayout& layout);

/// As `what_is_lost`.
std::vector<std::string> lost_in_las(const RecordLayout& layout);

}  // namespace raymoval
