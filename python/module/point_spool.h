// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/files/descriptor.h"
#include "python/module/array_source.h"

namespace raymoval::python {

/// Keeps points in a file without a name below TMPDIR (else /tmp): 12 bytes a point, 16 with
/// reflectance. In memory it keeps three numbers per scan.
class PointSpool : public PointStore {
 public:
  /// @throws DataError if the file cannot be made
  PointSpool();
  /// Adds the next scan; no other thread reads meanwhile. @throws DataError if the disk is full
  void add(const Cloud& cloud);
  [[nodiscard]] std::size_t size() const override { return entries_.size(); }
  /// @throws DataError if the file cannot be read
  [[nodiscard]] Cloud points(std::size_t scan) const override;

 private:
  struct Entry {
    std::uint64_t offset = 0;  ///< Bytes before it.
    std::size_t points = 0;
    bool has_reflectance = false;
  };
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path folder_;
  Descriptor file_;
  std::vector<Entry> entries_;
  std::uint64_t size_ = 0;
};

}  // namespace raymoval::python
