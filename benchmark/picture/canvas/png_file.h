// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace raymoval {

/// Pixels row by row from the top, three bytes (red, green, blue) each.
struct RgbImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The image as a PNG file's content; the same pixels give the same bytes.
std::string png_bytes(const RgbImage& image);

/// Writes it so that the file is there whole or not at all. @throws DataError
void write_png(const std::filesystem::path& path, const RgbImage& image);

/// @throws DataError if `path` is no PNG
RgbImage read_png(const std::filesystem::path& path);

}  // namespace raymoval
