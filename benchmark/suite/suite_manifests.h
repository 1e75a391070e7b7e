// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace raymoval {

/// A suite file whose methods "external:PATH" have the path of a manifest beside the suite file
/// (in `folder`) where there is one; others stay as they stand. What is no suite is left alone.
nlohmann::json with_located_manifests(nlohmann::json suite, const std::filesystem::path& folder);

}  // namespace raymoval
