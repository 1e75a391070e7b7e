// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace raymoval::fuzz {

/// Tries `bytes` as the cloud file `name`: as a cloud that is written and read again, as a scan,
/// and as a scan whose intensities are labels.
void try_cloud(const std::string& name, std::string_view bytes);

}  // namespace raymoval::fuzz
