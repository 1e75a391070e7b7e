// SPDX-License-Identifier: MIT
#include "benchmark/suite/suite_manifests.h"

#include <nlohmann/json.hpp>
#include <string>

#include "core/files/file_kind.h"
#include "methods/external/external.h"

namespace raymoval {

nlohmann::json with_located_manifests(nlohmann::json suite, const std::filesystem::path& folder) {
  if (!suite.is_object() || !suite.contains("methods") || !suite["methods"].is_array()) {
    return suite;
  }
  for (nlohmann::json& item : suite["methods"]) {
    nlohmann::json* name = &item;
    if (item.is_object() && item.contains("method")) name = &item["method"];
    if (!name->is_string()) continue;
    const auto manifest = external_manifest(name->get<std::string>());
    if (!manifest || !has_file(folder / *manifest)) continue;
    *name = "external:" + (folder / *manifest).string();
  }
  return suite;
}

}  // namespace raymoval
