// SPDX-License-Identifier: MIT
#include "benchmark/picture/canvas/png_file.h"

#include <png.h>

#include "core/error.h"
#include "core/files/files.h"

namespace raymoval {
namespace {

png_image header_of(const RgbImage& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  return header;
}

}  // namespace

std::string png_bytes(const RgbImage& image) {
  png_image header = header_of(image);
  png_alloc_size_t size = 0;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(header), '\0');
  size = bytes.size();
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) ==
      0) {
    throw InternalError(std::string("a picture cannot be coded: ") + header.message);
  }
  bytes.resize(size);
  return bytes;
}

void write_png(const std::filesystem::path& path, const RgbImage& image) {
  write_atomically(path, png_bytes(image));
}

RgbImage read_png(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  RgbImage image;
  bool good = png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) != 0;
  if (good) {
    header.format = PNG_FORMAT_RGB;
    image.width = static_cast<int>(header.width);
    image.height = static_cast<int>(header.height);
    image.rgb.resize(PNG_IMAGE_SIZE(header));
    good = png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr) != 0;
  }
  if (!good) throw DataError(path.string() + ": not a PNG file (" + header.message + ").");
  return image;
}

}  // namespace raymoval
