// SPDX-License-Identifier: MIT
#include "core/files/file_writer.h"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "core/error.h"
#include "core/files/files.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::TemporaryFolder;

namespace {

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// A disk with room for `bytes` in each file, for as long as it lives.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &small);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

}  // namespace

TEST_CASE("A file keeps what it held until all of the new content has its name") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  write_atomically(path, "before");
  FileWriter file(path);
  file.append("count 0, ");
  file.append("points");
  file.overwrite(6, "2");
  CHECK(read_text(path) == "before");
  file.sync();
  CHECK(read_text(path) == "before");
  file.commit();
  CHECK(read_text(path) == "count 2, points");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("A file that is given up leaves nothing") {
  const TemporaryFolder folder;
  { FileWriter(folder.path() / "a.txt").append("half"); }
  CHECK(files_in(folder.path()) == 0);
}

TEST_CASE("Only what was appended can be overwritten") {
  const TemporaryFolder folder;
  FileWriter file(folder.path() / "a.txt");
  file.append("abc");
  CHECK_THROWS_AS(file.overwrite(2, "xy"), InternalError);
}

TEST_CASE("A full disk is told, and what was there stays") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  write_atomically(path, "before");
  {
    const SmallDisk disk(100);
    FileWriter file(path);
    file.append(std::string(90, 'x'));
    CHECK_THROWS_WITH(file.append(std::string(90, 'x')),
                      Contains("a.txt: cannot be written") && Contains("Nothing was changed"));
  }
  CHECK(read_text(path) == "before");
  CHECK(files_in(folder.path()) == 1);
}
