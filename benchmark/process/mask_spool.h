// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "benchmark/process/timed_source.h"
#include "core/files/descriptor.h"
#include "methods/remover.h"

namespace raymoval {

/// Keeps a method's masks in a file without a name, one bit per point, and checks them as
/// `CheckedSink` does. In memory it keeps three numbers per scan.
class MaskSpool : public RemovalSink {
 public:
  /// @param method name for messages
  /// @param beside a path; the file is made in its folder
  /// @throws DataError if it cannot be made
  MaskSpool(std::string method, const TimedSource& scans, const std::filesystem::path& beside);

  /// @throws MethodError as `CheckedSink::accept`; DataError if the disk is full
  void accept(std::size_t scan, const Mask& mask) override;
  /// @throws MethodError naming the first scan without a mask
  void check_complete() const;
  [[nodiscard]] Mask get(std::size_t scan) const;
  [[nodiscard]] std::uint64_t point_count() const;
  [[nodiscard]] std::uint64_t removed_count() const { return removed_; }

 private:
  struct Entry {
    bool filled = false;
    std::uint64_t offset = 0;  ///< Bytes before the mask.
    std::size_t points = 0;
  };
  [[noreturn]] void fail(const char* what) const;

  std::string method_;
  const TimedSource& scans_;
  std::filesystem::path path_;  ///< Beside which the file is; it has no name itself.
  Descriptor file_;
  std::mutex mutex_;
  std::vector<Entry> entries_;
  std::uint64_t size_ = 0;
  std::uint64_t removed_ = 0;
};

}  // namespace raymoval
