// SPDX-License-Identifier: MIT
#include "datasets/clouds/frames.h"

#include "benchmark/suite/suite.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

const std::vector<NumberedFile>& ten_files() {
  static const std::vector<NumberedFile> files = [] {
    std::vector<NumberedFile> made;
    for (long i = 0; i < 10; ++i) made.push_back({i, std::to_string(i) + ".bin"});
    return made;
  }();
  return files;
}

/// Frame ranges, settings and the order of file names, as the command line takes them.
void try_frames(std::string_view bytes) {
  const std::string text(bytes.substr(0, bytes.find('\0')));  // As a command line has it.
  fuzz::may_refuse([&] {
    const FrameRange range = parse_frame_range(text);
    const FrameRange again = parse_frame_range(frame_range_text(range));
    fuzz::require(
        range.first == again.first && range.last == again.last && range.stride == again.stride,
        "a frame range changes when written and read");
    fuzz::require(!choose_frames(ten_files(), range, "folder").files.empty(), "no frame is chosen");
  });
  fuzz::may_refuse([&] {
    const Setting setting = parse_setting(text);
    fuzz::require(setting.target + "." + setting.key + "=" + setting.value == text,
                  "a setting loses a part");
  });
  const std::string_view left = bytes.substr(0, bytes.size() / 2);
  const std::string_view right = bytes.substr(bytes.size() / 2);
  fuzz::require(!(natural_less(left, right) && natural_less(right, left)), "an order has a ring");
  fuzz::require(left == right || natural_less(left, right) || natural_less(right, left),
                "an order has a tie");
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(frames, try_frames)
