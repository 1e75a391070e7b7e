// SPDX-License-Identifier: MIT
// A file system that refuses locks: this program's flock is found before that of the C library. To
// be included once in a program.
#pragma once

#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace raymoval::test {

/// Refuses locks while it lives.
class RefusingLocks {
 public:
  explicit RefusingLocks(int reason) { error() = reason; }
  ~RefusingLocks() { error() = 0; }
  RefusingLocks(const RefusingLocks&) = delete;
  RefusingLocks& operator=(const RefusingLocks&) = delete;

  /// With which error the system refuses locks; 0: it does not.
  static int& error() {
    static int reason = 0;
    return reason;
  }
};

}  // namespace raymoval::test

extern "C" int flock(int file, int operation) noexcept {
  const int reason = raymoval::test::RefusingLocks::error();
  if (reason == 0) return static_cast<int>(::syscall(SYS_flock, file, operation));
  errno = reason;
  return -1;
}
