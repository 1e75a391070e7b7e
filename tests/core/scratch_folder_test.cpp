// SPDX-License-Identifier: MIT
// What is written to TMPDIR does not stay there when its process is killed.
#include "core/files/scratch_folder.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "core/files/file_kind.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
namespace fs = std::filesystem;

namespace {

/// A folder that is TMPDIR as long as it lives.
class OwnTmpdir {
 public:
  OwnTmpdir() {
    if (const char* named = std::getenv("TMPDIR")) before_ = named;
    ::setenv("TMPDIR", folder_.text().c_str(), 1);
  }
  ~OwnTmpdir() {
    if (before_) {
      ::setenv("TMPDIR", before_->c_str(), 1);
    } else {
      ::unsetenv("TMPDIR");
    }
  }
  OwnTmpdir(const OwnTmpdir&) = delete;
  OwnTmpdir& operator=(const OwnTmpdir&) = delete;
  [[nodiscard]] const test::TemporaryFolder& folder() const { return folder_; }
  [[nodiscard]] std::size_t entries() const { return entries_of(folder_.path()).size(); }

 private:
  test::TemporaryFolder folder_;
  std::optional<std::string> before_;
};

/// Makes a temporary folder with a file in a process that then ends as if killed.
void leave_temporary_folder() {
  const pid_t child = ::fork();
  if (child == 0) {
    const auto* folder = new ScratchFolder(kRecordingFolder);
    std::ofstream(folder->path() / "drive.db3") << "unpacked";
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(status == 0);
}

}  // namespace

TEST_CASE("A temporary folder is its user's alone and goes with its object") {
  const OwnTmpdir tmpdir;
  {
    const ScratchFolder folder(kRecordingFolder);
    struct stat status {};
    REQUIRE(::stat(folder.path().c_str(), &status) == 0);
    CHECK((status.st_mode & 0777U) == 0700U);
    CHECK(folder.path().parent_path() == tmpdir.folder().path());
    std::ofstream(folder.path() / "drive.db3") << "unpacked";
  }
  CHECK(tmpdir.entries() == 0);
}

TEST_CASE("A process removes what killed processes left before it") {
  const OwnTmpdir tmpdir;
  leave_temporary_folder();
  leave_temporary_folder();
  REQUIRE(tmpdir.entries() > 0);
  const ScratchFolder folder(kRecordingFolder);
  CHECK(entries_of(tmpdir.folder().path()) == std::vector<fs::path>{folder.path()});
}

TEST_CASE("The folder of a killed process can be removed, and that of a running one stays") {
  const OwnTmpdir tmpdir;
  (void)tmpdir.folder().write("other/file", "");
  const ScratchFolder living(kRecordingFolder);
  leave_temporary_folder();
  REQUIRE(tmpdir.entries() == 3);
  remove_abandoned_scratch_folders();
  CHECK(tmpdir.entries() == 2);
  CHECK(fs::exists(living.path()));
  CHECK(fs::exists(tmpdir.folder() / "other/file"));
}
