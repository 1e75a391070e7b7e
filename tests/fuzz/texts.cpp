// SPDX-License-Identifier: MIT
// Texts of the command line.
#include "benchmark/suite/suite.h"
#include "datasets/clouds/frames.h"
#include "datasets/simulation/scene/scene_text.h"
#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

const std::vector<NumberedFile>& ten_files() {
  static const std::vector<NumberedFile> files = [] {
    std::vector<NumberedFile> made;
    for (long i = 0; i < 10; ++i) made.push_back({i, std::to_string(i) + ".bin"});
    return made;
  }();
  return files;
}

/// Frame ranges, settings and the order of file names, as the command line takes them.
RAYMOVAL_FUZZ_TARGET(frames) {
  const std::string text(bytes.substr(0, bytes.find('\0')));  // As a command line has it.
  may_refuse([&] {
    const FrameRange range = parse_frame_range(text);
    const FrameRange again = parse_frame_range(frame_range_text(range));
    require(range.first == again.first && range.last == again.last && range.stride == again.stride,
            "a frame range changes when written and read");
    require(!choose_frames(ten_files(), range, "folder").files.empty(), "no frame is chosen");
  });
  may_refuse([&] {
    const Setting setting = parse_setting(text);
    require(setting.target + "." + setting.key + "=" + setting.value == text,
            "a setting loses a part");
  });
  const std::string_view left = bytes.substr(0, bytes.size() / 2);
  const std::string_view right = bytes.substr(bytes.size() / 2);
  require(!(natural_less(left, right) && natural_less(right, left)), "an order has a ring");
  require(left == right || natural_less(left, right) || natural_less(right, left),
          "an order has a tie");
}

RAYMOVAL_FUZZ_TARGET(scene) {
  // Neither a command line nor a suite file can hold a zero byte.
  const std::string text(bytes.substr(0, bytes.find('\0')));
  may_refuse([&] { (void)names_scene(text); });
  may_refuse([&] {
    const SimulationOptions options = parse_scene(text);
    require(options.scene.size() <= text.size(), "a scene's name grows");
    require(options.pose_noise >= 0.0, "pose noise is below zero");
  });
}

}  // namespace
}  // namespace raymoval::fuzz
