// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// Writes PCD files, binary ones unless `form` says otherwise. VIEWPOINT is that of the rows if all
/// have the same; WIDTH and HEIGHT are those of an organised cloud that is given in one piece. The
/// rows of a compressed file are in memory until its end; its fields take at most 4 GiB.
std::unique_ptr<RecordEncoder> pcd_encoder(const StoredForm& form = {});

/// As `what_is_lost`.
std::vector<std::string> lost_in_pcd(const RecordLayout& layout);

}  // namespace raymoval
