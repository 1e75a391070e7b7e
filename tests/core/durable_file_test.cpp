// SPDX-License-Identifier: MIT
// In which order a file reaches the disk. What the code under test asks of the system passes here
// on its way: this program's fsync and rename are found before those of the C library.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using test::TemporaryFolder;

namespace {

/// A request to the system: a file that is put on the disk, or one that gets another name.
struct Request {
  std::string what;
  std::filesystem::path path, new_path = {};
  std::int64_t bytes = 0;
};

std::vector<Request> requests;
bool recording = false;

/// Keeps what is asked of the system while it lives.
class Recording {
 public:
  Recording() {
    requests.clear();
    recording = true;
  }
  ~Recording() { recording = false; }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
};

}  // namespace

extern "C" int fsync(int file) {
  if (recording) {
    struct stat status {};
    ::fstat(file, &status);
    requests.push_back({"sync",
                        std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(file)),
                        {},
                        status.st_size});
  }
  return static_cast<int>(::syscall(SYS_fsync, file));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  if (recording) requests.push_back({"rename", from, to});
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

TEST_CASE("All of a file is on the disk before it gets its name, and its name is right after") {
  const TemporaryFolder folder;
  const std::filesystem::path path = std::filesystem::canonical(folder.path()) / "a.txt";
  const Recording begun;
  write_atomically(path, "nine byte");
  REQUIRE(requests.size() == 3);
  CHECK(requests[0].what == "sync");
  CHECK(name_of_part(requests[0].path) == "a.txt");
  CHECK(requests[0].bytes == 9);
  CHECK(requests[1].what == "rename");
  CHECK(requests[1].path == requests[0].path);
  CHECK(requests[1].new_path == path);
  CHECK(requests[2].what == "sync");
  CHECK(requests[2].path == path.parent_path());
}

TEST_CASE("A file that is on the disk already is put there again only for what came since") {
  const TemporaryFolder folder;
  FileWriter file(folder.path() / "a.txt");
  file.append("ab");
  {
    const Recording begun;
    file.sync();
    file.sync();
    CHECK(requests.size() == 1);
    file.overwrite(0, "c");
    file.sync();
    CHECK(requests.size() == 2);
    file.append("d");
    file.commit();
  }
  REQUIRE(requests.size() == 5);
  CHECK(requests[2].bytes == 3);
  CHECK(requests[3].what == "rename");
  CHECK(read_text(folder.path() / "a.txt") == "cbd");
}

TEST_CASE("A file in the working folder has its name on the disk, too") {
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  {
    const Recording begun;
    write_atomically("a.txt", "x");
  }
  std::filesystem::current_path(before);
  REQUIRE(requests.size() == 3);
  CHECK(requests[2].path == std::filesystem::canonical(folder.path()));
}
