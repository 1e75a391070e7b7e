// SPDX-License-Identifier: MIT
// What the system says of a lock passes here: this program's flock is found before that of the C
// library.
#include "core/files/file_lock.h"

#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>

#include "core/error.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::TemporaryFolder;

namespace {

int refused_lock = 0;  ///< With which error the system refuses a lock; 0: it does not.

/// Refuses locks while it lives.
class RefusingLocks {
 public:
  explicit RefusingLocks(int reason) { refused_lock = reason; }
  ~RefusingLocks() { refused_lock = 0; }
  RefusingLocks(const RefusingLocks&) = delete;
  RefusingLocks& operator=(const RefusingLocks&) = delete;
};

}  // namespace

extern "C" int flock(int file, int operation) noexcept {
  if (refused_lock == 0) return static_cast<int>(::syscall(SYS_flock, file, operation));
  errno = refused_lock;
  return -1;
}

TEST_CASE("A file system that says it has no locks is told from one that fails to give one") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "run.lock";
  for (const int reason : {ENOSYS, ENOTSUP, EINVAL}) {
    INFO(reason);
    const RefusingLocks all(reason);
    CHECK(FileLock(file).take(FileLock::Mode::kExclusive) == FileLock::State::kNoLocks);
  }
  for (const int reason : {EIO, ENOLCK, EBADF}) {
    INFO(reason);
    const RefusingLocks all(reason);
    FileLock lock(file);
    CHECK_THROWS_WITH(
        lock.take(FileLock::Mode::kShared),
        Contains("run.lock: cannot be locked (" + std::generic_category().message(reason) + ")"));
  }
  FileLock held(file), other(file);
  CHECK(held.take(FileLock::Mode::kExclusive) == FileLock::State::kHeld);
  CHECK(other.take(FileLock::Mode::kExclusive) == FileLock::State::kBusy);
}
