// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace raymoval {

/// A text as grey values: how much of each pixel it covers, 0 .. 255.
struct TextBitmap {
  int width = 0, height = 0;
  int baseline = 0;  ///< Row of the baseline, from the top.
  std::vector<std::uint8_t> coverage;
};

/// DejaVu Sans, from the file that $RAYMOVAL_FONT names or from where systems keep it.
class Font {
 public:
  /// @throws ConfigurationError if there is none
  Font();
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// @param text UTF-8; other bytes are shown as the font's sign for what it does not have
  /// @param size of the letters in pixels
  [[nodiscard]] TextBitmap draw(const std::string& text, int size) const;
  [[nodiscard]] int width(const std::string& text, int size) const;
  /// `text`, or as much of its beginning as fits with "..." behind it.
  [[nodiscard]] std::string fitted(const std::string& text, int size, int width) const;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace raymoval
