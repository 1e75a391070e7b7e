// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/files/descriptor.h"

namespace raymoval {

/// Keeps a piece of bytes for each scan in a file without a name. In memory it keeps two numbers
/// per scan.
class ScanSpool {
 public:
  /// @param what it keeps, for messages: "masks"
  /// @param beside a path; the file is made in its folder
  /// @throws DataError if it cannot be made
  ScanSpool(std::string what, const std::filesystem::path& beside, std::size_t scans);

  /// Keeps the piece of a scan, one thread at a time. @throws DataError if the disk is full
  void put(std::size_t scan, const std::string& piece);
  /// The piece of a scan; empty if there is none.
  [[nodiscard]] std::string get(std::size_t scan) const;

 private:
  struct Piece {
    std::uint64_t offset = 0;
    std::size_t bytes = 0;
  };
  [[noreturn]] void fail(const char* problem) const;

  std::string what_;
  std::filesystem::path path_;  ///< Beside which the file is; it has no name itself.
  Descriptor file_;
  std::vector<Piece> pieces_;
  std::uint64_t size_ = 0;
};

}  // namespace raymoval
