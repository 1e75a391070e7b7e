// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/file_kind.h"
#include "datasets/sequence.h"

namespace raymoval {

/// A scan file and the number its frame has in the data set.
struct NumberedFile {
  long number = 0;
  std::filesystem::path path;
};

/// Files of `folder` whose extension is one of `extensions` (".bin"), hidden ones left out, in
/// natural order (digit runs compare as numbers, so scan_2 comes before scan_10).
/// @throws DataError if the folder cannot be read
std::vector<std::filesystem::path> list_files(const std::filesystem::path& folder,
                                              const std::vector<std::string>& extensions);

/// Files named by their frame number, such as 000123.bin, in order of number.
/// @throws DataError if a name is no number, a number occurs twice, or there is no file
std::vector<NumberedFile> list_numbered_files(const std::filesystem::path& folder,
                                              const std::string& extension);

/// True if `a` comes before `b` with digit runs compared as numbers.
bool natural_less(std::string_view a, std::string_view b);

/// What a range selects from the files there are.
struct ChosenFrames {
  std::vector<NumberedFile> files;
  FrameRange range;  ///< With both ends filled in.
};

/// "4 frames from 2350 to 2356". @param files at least one, in order of number
std::string frame_extent_text(const std::vector<NumberedFile>& files);

/// Selects `range` from `files` (in order of number, at least one). The stride counts from the
/// first frame of the range. With an end given, every frame of the range has to exist; with none,
/// what is on disk is the sequence, so that partial copies of a data set can be used.
/// @param where folder named in messages
/// @throws DataError saying which frames there are
ChosenFrames choose_frames(const std::vector<NumberedFile>& files, const FrameRange& range,
                           const std::string& where);

}  // namespace raymoval
