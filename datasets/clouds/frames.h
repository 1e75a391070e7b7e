// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/file_kind.h"

namespace raymoval {

/// `FIRST:LAST:STRIDE` over frame numbers, ends included; any part may be empty (`::2`).
struct FrameRange {
  std::optional<long> first;
  std::optional<long> last;
  long stride = 1;
};

/// @throws UsageError saying what the form is.
FrameRange parse_frame_range(const std::string& text);
std::string frame_range_text(const FrameRange& range);

/// A scan file and its frame number in the data set.
struct NumberedFile {
  long number = 0;
  std::filesystem::path path;
};

/// Files of `folder` whose names end in one of `extensions` (".bin", ".pcd"), hidden ones left
/// out, in natural order (digit runs compare as numbers, so scan_2 comes before scan_10).
/// @throws DataError if the folder cannot be read
std::vector<std::filesystem::path> list_files(const std::filesystem::path& folder,
                                              const std::vector<std::string>& extensions);

/// "calib.txt, labels/, velodyne/ and 3 more": up to eight names in `folder`, for messages.
/// @throws DataError if the folder cannot be read
std::string content_text(const std::filesystem::path& folder);

/// Files named by their frame number, such as 000123.bin, in order of number.
/// @throws DataError if a name is no number, a number occurs twice, or there is no file
std::vector<NumberedFile> list_numbered_files(const std::filesystem::path& folder,
                                              const std::string& extension);

/// True if `a` comes before `b` with digit runs compared as numbers.
bool natural_less(std::string_view a, std::string_view b);

/// The files that a range selects.
struct ChosenFrames {
  std::vector<NumberedFile> files;
  FrameRange range;  ///< With both ends filled in.
};

/// "4 frames from 2350 to 2356". @param files at least one, in order of number
std::string frame_extent_text(const std::vector<NumberedFile>& files);

/// Selects `range` from `files` (in order of number, at least one). The stride counts from the
/// first frame of the range. If `range` has an end, every frame of it must exist. Else the files
/// on disk are the sequence, so that partial copies of a data set can be used.
/// @param where folder named in messages
/// @throws DataError listing the frames that exist
ChosenFrames choose_frames(const std::vector<NumberedFile>& files, const FrameRange& range,
                           const std::string& where);

}  // namespace raymoval
