// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// The known formats, the usual first.
const std::vector<CloudFormat>& cloud_formats();

/// Endings of files that are read: ".pcd" and so on, also packed with gzip: ".pcd.gz".
const std::vector<std::string>& cloud_extensions();

/// Endings of files that are written piece by piece, such as maps.
const std::vector<std::string>& written_extensions();

/// The one of `cloud_extensions` that the name of `path` ends in, or an empty text.
std::string cloud_extension(const std::filesystem::path& path);

/// The name of `path` without its folder and `cloud_extension`: "000123" of a/000123.pcd.gz.
std::string cloud_stem(const std::filesystem::path& path);

/// Whether `path` names a file of points that is packed with gzip.
bool is_packed(const std::filesystem::path& path);

/// @throws UsageError naming the known endings if that of `path` is none, or is that of a format
///   that is known and not read
const CloudFormat& format_read(const std::filesystem::path& path);

/// @throws UsageError naming the known endings if that of `path` is none
const CloudFormat& format_written(const std::filesystem::path& path);

}  // namespace raymoval
