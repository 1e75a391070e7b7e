// SPDX-License-Identifier: MIT
// A calibration that cannot be read is not replaced by the usual axes of a camera.
#include <catch2/catch.hpp>

#include "core/files/file_kind.h"
#include "datasets/inspection/evidence/pose_hypotheses.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/datasets/unreadable.h"

using namespace raymoval;
using namespace raymoval::test;

TEST_CASE("inspection tells a calibration that cannot be read, and does without a damaged one",
          "[inspect][no-files]") {
  const TemporaryFolder folder;
  for (const char* name : {"000000.bin", "000001.bin", "000002.bin"}) {
    folder.write(std::string("velodyne/") + name, floats({5, 0, 0, 1}));
  }
  folder.write("poses.txt", kIdentityRow + kIdentityRow + kIdentityRow);
  const auto calibration = folder.write("calib.txt", "Tr: " + kIdentityRow);
  const Sequence sequence = open_sequence(folder.text(), {});
  inspection::Samples samples(sequence, 1, nullptr);
  {
    const NothingOpens full;
    const std::string message =
        message_of<UnreadableError>([&] { inspection::pose_hypotheses(samples); });
    check_says(message, {calibration.string()});
  }
  folder.write("calib.txt", "no row");
  CHECK_FALSE(inspection::pose_hypotheses(samples).empty());
}
