// SPDX-License-Identifier: MIT
#pragma once

#include <sys/resource.h>

#include <filesystem>

namespace raymoval::test {

/// As long as it lives, this process may look at files and cannot open any. A test with it has the
/// tag [no-files].
class NothingOpens {
 public:
  NothingOpens() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NothingOpens() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  NothingOpens(const NothingOpens&) = delete;
  NothingOpens& operator=(const NothingOpens&) = delete;

 private:
  rlimit before_{};
};

/// Puts a link to itself in the place of a file, which the system refuses to follow.
inline void make_unreadable(const std::filesystem::path& file) {
  std::filesystem::remove(file);
  std::filesystem::create_symlink(file.filename(), file);
}

}  // namespace raymoval::test
