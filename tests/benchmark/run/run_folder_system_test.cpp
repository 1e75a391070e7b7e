// SPDX-License-Identifier: MIT
// The system calls of a run for its folders, and its reaction to errors: this program's fsync
// replaces that of the C library.
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/run/folder/cell_store.h"
#include "benchmark/run/runner.h"
#include "core/error.h"
#include "tests/benchmark/small_suite.h"
#include "tests/core/refusing_locks.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

bool keeps_syncs = false;
std::vector<fs::path> syncs;  ///< What was put on the disk, in order.

/// Keeps what is put on the disk while it lives.
class KeptSyncs {
 public:
  KeptSyncs() {
    syncs.clear();
    keeps_syncs = true;
  }
  ~KeptSyncs() { keeps_syncs = false; }
  KeptSyncs(const KeptSyncs&) = delete;
  KeptSyncs& operator=(const KeptSyncs&) = delete;
};

/// The message of a run of one control on one scan, as a run or as one cell.
std::string said_by_run(const fs::path& out, bool as_cell) {
  const Suite suite = test::noop_on("street");
  const std::unique_ptr<std::FILE, void (*)(std::FILE*)> log(
      std::tmpfile(), [](std::FILE* file) { std::fclose(file); });
  Progress progress(ProgressStyle::kLog, log.get());
  if (as_cell) {
    run_one_cell(suite, {.out = out, .progress = &progress}, "street/noop:default");
  } else {
    run_suite(suite, {.out = out, .progress = &progress});
  }
  std::rewind(log.get());
  std::string text;
  for (int c = std::fgetc(log.get()); c != EOF; c = std::fgetc(log.get())) {
    text += static_cast<char>(c);
  }
  return text;
}

}  // namespace

extern "C" int fsync(int file) {
  if (keeps_syncs) syncs.push_back(fs::read_symlink("/proc/self/fd/" + std::to_string(file)));
  return static_cast<int>(::syscall(SYS_fsync, file));
}

TEST_CASE("The folders of a cell have their names on the disk before something is written there") {
  const test::TemporaryFolder folder;
  const fs::path out = fs::canonical(folder.path()) / "run";
  const CellStore store(out);
  const KeptSyncs begun;
  store.prepare({"town", "comb"});
  CHECK(syncs == std::vector<fs::path>{out.parent_path(), out, out / "cells", out / "cells/town"});
  store.prepare({"town", "other"});
  CHECK(syncs.size() == 5);  // Only the last folder is new.
  store.prepare({"town", "other"});
  CHECK(syncs.size() == 5);
}

TEST_CASE("A run says that its folder has no locks, and does not begin if a lock fails") {
  const test::TemporaryFolder folder;
  for (const bool as_cell : {false, true}) {
    const fs::path out = folder.path() / (as_cell ? "cell" : "suite");
    {
      const test::RefusingLocks none(ENOSYS);
      CHECK_THAT(said_by_run(out, as_cell),
                 Contains("the file system of " + out.string() + " has no locks"));
    }
    CHECK_THAT(said_by_run(out, as_cell), !Contains("no locks"));
    const test::RefusingLocks broken(EIO);
    CHECK_THROWS_WITH(said_by_run(out, as_cell),
                      Contains("run.lock: cannot be locked (Input/output error)") &&
                          Contains("choose another --out"));
  }
}
