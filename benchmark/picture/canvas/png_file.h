// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "benchmark/picture/canvas/canvas.h"

namespace raymoval {

/// The picture as a PNG file's content. The same pixels give the same bytes.
std::string png_bytes(const Canvas& canvas);

/// Writes a PNG file so that it is there whole or not at all. @throws DataError
void write_png(const std::filesystem::path& path, const Canvas& canvas);

/// @throws DataError if `path` is no PNG
Canvas read_png(const std::filesystem::path& path);

}  // namespace raymoval
