// SPDX-License-Identifier: MIT
// A disk that fails under an open recording is reported, and is not taken for damage.
#include <fcntl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "core/files/descriptor.h"
#include "core/files/file_kind.h"
#include "datasets/bags/bag.h"
#include "tests/datasets/bags/recordings.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// Replaces each open file `path` by a folder, of which each read fails. @return number of files
int fail_reads_of(const fs::path& path) {
  const fs::path whole = fs::canonical(path);
  const Descriptor folder(::open("/", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  int found = 0;
  for (int file = 0; file < 256; ++file) {
    std::error_code none;
    const fs::path link = fs::read_symlink("/proc/self/fd/" + std::to_string(file), none);
    if (none || link != whole) continue;
    REQUIRE(::dup2(folder.get(), file) == file);
    ++found;
  }
  return found;
}

TEST_CASE("A disk that fails below a recording is no damage", "[bags]") {
  const std::string name = GENERATE("bag_ros1/rosbag_none.bag", "bag_ros1/rosbag_lz4.bag",
                                    "bag_mcap/chunks.mcap", "bag_mcap/no_chunks.mcap");
  CAPTURE(name);
  const TemporaryFolder folder;
  const fs::path path = folder.write("drive" + fs::path(name).extension().string(),
                                     test::file_bytes(test::recording(name)));
  const auto bag = open_bag(path);
  REQUIRE(fail_reads_of(path) > 0);
  const std::string message = test::message_of<UnreadableError>([&] { (void)bag->message(0, 0); });
  test::check_says(message, {path.filename().string(), "cannot be read", "disk"});
  CHECK(bag->damage().empty());
}

}  // namespace
}  // namespace raymoval
