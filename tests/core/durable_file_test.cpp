// SPDX-License-Identifier: MIT
// The order in which a file reaches the disk, and the result of system errors. This program's
// fsync, rename and fchown replace those of the C library, so that calls of the code under test are
// recorded here.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/files/replacements.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;
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

/// With which error the system refuses something; 0: it does not.
struct Refusals {
  int sync_file = 0, sync_folder = 0, rename = 0;
  /// To give a file to another user, or to another group.
  int owner = 0, group = 0;
};
Refusals refused;

/// The rights of files at the time when they were given away.
std::vector<mode_t> rights_when_given;

/// Refuses while it lives.
class Refusing {
 public:
  explicit Refusing(const Refusals& what) { refused = what; }
  ~Refusing() { refused = {}; }
  Refusing(const Refusing&) = delete;
  Refusing& operator=(const Refusing&) = delete;
};

int refusal(int reason) {
  errno = reason;
  return -1;
}

mode_t all_rights_of(const std::filesystem::path& path) {
  struct stat status {};
  REQUIRE(::lstat(path.c_str(), &status) == 0);
  return status.st_mode & 07777U;
}

std::size_t entries_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Records system calls while it lives.
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
  if (refused.sync_file != 0 || refused.sync_folder != 0) {
    struct stat status {};
    ::fstat(file, &status);
    const int reason = S_ISDIR(status.st_mode) ? refused.sync_folder : refused.sync_file;
    if (reason != 0) return refusal(reason);
  }
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
  if (refused.rename != 0) return refusal(refused.rename);
  if (recording) requests.push_back({"rename", from, to});
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

extern "C" int fchown(int file, uid_t owner, gid_t group) noexcept {
  struct stat status {};
  ::fstat(file, &status);
  rights_when_given.push_back(status.st_mode & 0777U);
  if (owner != static_cast<uid_t>(-1) && refused.owner != 0) return refusal(refused.owner);
  if (owner == static_cast<uid_t>(-1) && refused.group != 0) return refusal(refused.group);
  return static_cast<int>(::syscall(SYS_fchown, file, owner, group));
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

TEST_CASE("A file that does not reach the disk is told, and what was there stays") {
  const TemporaryFolder folder;
  const auto path = folder.write("a.txt", "before");
  {
    const Refusing file({.sync_file = EIO});
    CHECK_THROWS_WITH(write_atomically(path, "after"),
                      Contains("a.txt: cannot be written (Input/output error). The file is as it "
                               "was; free space or choose another place."));
    FileWriter writer(path);
    CHECK_THROWS_AS(writer.sync(), DataError);
    CHECK_THROWS_AS(writer.sync(), DataError);  // It is not on the disk the second time either.
  }
  {
    const Refusing name({.rename = EACCES});
    CHECK_THROWS_WITH(write_atomically(path, "after"),
                      Contains("a.txt: cannot be written (Permission denied)"));
  }
  CHECK(read_text(path) == "before");
  CHECK(entries_in(folder.path()) == 1);
}

TEST_CASE("A file whose owner or group cannot be kept gives nobody more than before") {
  const TemporaryFolder folder;
  const auto path = folder.write("a.txt", "before");
  const auto rights_after = [&](mode_t before, const Refusals& what) {
    REQUIRE(::chmod(path.c_str(), before) == 0);
    const Refusing owner(what);
    write_atomically(path, "after");
    return all_rights_of(path);
  };
  rights_when_given.clear();
  // The first digit is no right of the owner.
  CHECK(rights_after(04755, {}) == 0755);
  CHECK(rights_when_given == std::vector<mode_t>{0600});
  // Its group is that of before, so that this keeps its rights.
  CHECK(rights_after(0674, {.owner = EPERM}) == 0674);
  CHECK(rights_when_given == std::vector<mode_t>{0600, 0600, 0600});
  // It is another group, which may do what others may.
  CHECK(rights_after(0674, {.owner = EPERM, .group = EPERM}) == 0644);
  CHECK(rights_after(0640, {.owner = EPERM, .group = EPERM}) == 0600);
  CHECK(rights_after(0447, {.owner = EPERM, .group = EPERM}) == 0447);
  CHECK(rights_after(0777, {.owner = EPERM, .group = EPERM}) == 0777);
}
