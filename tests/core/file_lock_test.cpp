// SPDX-License-Identifier: MIT
#include "core/files/file_lock.h"

#include <catch2/catch.hpp>
#include <cerrno>

#include "core/error.h"
#include "tests/core/refusing_locks.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::RefusingLocks;
using test::TemporaryFolder;

TEST_CASE("A file system that says it has no locks is told from one that fails to give one") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "run.lock";
  for (const int reason : {ENOSYS, ENOTSUP, EINVAL}) {
    INFO(reason);
    const RefusingLocks all(reason);
    CHECK(FileLock(file).take(FileLock::Mode::kExclusive) == FileLock::State::kNoLocks);
    CHECK_FALSE(std::filesystem::exists(file));
  }
  for (const int reason : {EIO, ENOLCK, EBADF}) {
    INFO(reason);
    const RefusingLocks all(reason);
    FileLock lock(file);
    CHECK_THROWS_WITH(
        lock.take(FileLock::Mode::kShared),
        Contains("run.lock: cannot be locked (" + std::generic_category().message(reason) + ")"));
    CHECK_FALSE(std::filesystem::exists(file));
  }
  FileLock held(file), other(file);
  CHECK(held.take(FileLock::Mode::kExclusive) == FileLock::State::kHeld);
  CHECK(other.take(FileLock::Mode::kExclusive) == FileLock::State::kBusy);
}
