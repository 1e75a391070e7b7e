// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace raymoval {

/// Keeps a piece of bytes for each scan, in memory or in a file without a name. With a file it
/// keeps a few numbers per scan in memory. Copies share the file.
class ScanSpool {
 public:
  /// Keeps the pieces in memory.
  ScanSpool() = default;
  explicit ScanSpool(std::size_t scans) : pieces_(scans) {}
  /// Keeps the pieces in a file that is deleted when the program ends, even if it is killed.
  /// @param beside a path; the file is made in its folder
  /// @param what the pieces are, for messages: "masks"
  /// @throws DataError if the file cannot be made
  ScanSpool(std::size_t scans, const std::filesystem::path& beside, const std::string& what);

  [[nodiscard]] std::size_t size() const { return pieces_.size(); }
  [[nodiscard]] bool has(std::size_t scan) const { return pieces_[scan].is_filled; }
  /// Keeps the piece of a scan. Different scans may be put from different threads.
  /// @throws DataError if the disk is full
  void put(std::size_t scan, std::string piece);
  /// Keeps the piece of one more scan. No other thread may use this object meanwhile.
  void append(std::string piece);
  /// The piece of a scan; empty if there is none. @throws DataError if the file cannot be read
  [[nodiscard]] std::string get(std::size_t scan) const;
  /// Memory of the pieces, bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct File;
  struct Piece {
    std::string bytes;  ///< Empty if the piece is in the file.
    std::uint64_t offset = 0;
    std::size_t size = 0;
    bool is_filled = false;
  };
  std::shared_ptr<File> file_;  ///< Null: the pieces are in memory.
  std::vector<Piece> pieces_;
};

}  // namespace raymoval
