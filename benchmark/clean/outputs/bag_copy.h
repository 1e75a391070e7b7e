// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/clean/outputs/clean_output.h"
#include "core/files/descriptor.h"
#include "datasets/bag_scans/bag_source.h"
#include "datasets/sequence.h"

namespace raymoval {

/// The recording that a sequence is read from. Null if it is read from something else.
const BagScanSource* bag_source(const Sequence& sequence);

/// Refuses what cannot be written: another kind of recording than the one that is read, or the same
/// place. @throws UsageError
void check_bag_copy(const Sequence& sequence, const std::filesystem::path& path);

/// A recording again, whose messages with points lack those that were removed or left out. Messages
/// of scans that were not cleaned, such as those outside --frames, and all other messages stay as
/// they are. Which points stay is kept in a file without a name, a bit a point.
class BagCopy : public CleanOutput {
 public:
  /// @param sequence of a bag; it must outlive this object
  /// @throws UsageError as `check_bag_copy`; DataError if nothing can be written there
  /// @param cancel the writing is given up when this becomes true
  BagCopy(const std::filesystem::path& path, const Sequence& sequence,
          const std::atomic<bool>& cancel);

  void add(const CleanedScan& scan) override;
  void finish() override;
  /// Writes the recording. @throws DataError
  void commit_with(Replacements& together) override;

 private:
  struct Kept {
    std::size_t message = 0;
    std::uint64_t offset = 0;  ///< Bytes before it in the file.
    std::size_t points = 0;
  };
  [[nodiscard]] std::vector<std::uint8_t> kept_points(const Kept& kept) const;

  std::filesystem::path path_;
  const BagScanSource& source_;
  const std::atomic<bool>& cancel_;
  Descriptor bits_;
  std::uint64_t size_ = 0;
  std::vector<Kept> kept_;  ///< In order of messages.
};

}  // namespace raymoval
