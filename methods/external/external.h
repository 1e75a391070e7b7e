// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "methods/method_entry.h"

namespace raymoval {

// An external method is a program in any language. A manifest names it and its parameters. The
// program gets scans and parameters as files in a working folder and answers with a label file for
// each scan (see docs/your-method.md for the layout).

/// "PATH/manifest.json" for the name "external:PATH/manifest.json"; no value for the name of a
/// method of another kind.
std::optional<std::filesystem::path> external_manifest(const std::string& method_name);

/// The entry of the method that a manifest describes, with one variant, "default". Its version is
/// the manifest's with a hash of the manifest and of the program's files, so that results of
/// another version of the program are not reused.
/// @throws ConfigurationError for an invalid manifest; DataError if a file that belongs to the
/// program cannot be read
MethodEntry external_entry(const std::filesystem::path& manifest);

}  // namespace raymoval
