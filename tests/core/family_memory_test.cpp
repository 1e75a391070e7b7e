// SPDX-License-Identifier: MIT
// What the memory of several processes is. 1 MiB is 2^20 bytes.
#include "core/process/process_family.h"

#include <sys/mman.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "core/files/descriptor_io.h"
#include "tests/core/shell_children.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;
using Kind = ChildEnd::Kind;

namespace {

constexpr std::size_t kMib = 1 << 20;

ChildSetup limited_mib(const std::string& script, double mib) {
  ChildSetup setup = limited(script, 60);
  setup.limits.memory_mib = mib;
  return setup;
}

/// Perl that takes 80 MiB, of which a line with many blanks is made, in a parent and four children.
/// Perl itself keeps the string twice: 160 MiB.
std::string forking(const std::string& child, const std::string& parent) {
  return "exec perl -e '$n = 80 << 20; $x = \" \" x $n; for (1 .. 4) { if (!fork) { " + child +
         "; select(undef, undef, undef, 600) } } " + parent + "'";
}

/// Children of this process that do nothing until they are ended.
struct Idle {
  explicit Idle(int count) {
    for (int i = 0; i < count; ++i) {
      members.push_back(::fork());
      if (members.back() == 0) {
        for (;;) ::pause();
      }
    }
    members.push_back(::getpid());
  }
  ~Idle() {
    members.pop_back();
    for (const pid_t child : members) {
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
    }
  }
  std::vector<pid_t> members;
};

/// A limit that everything exceeds, so that each measurement is exact.
constexpr double kAnyMib = 0.001;

double exact_mib(const std::vector<pid_t>& members) {
  return FamilyMemory(kAnyMib).measure(members);
}

}  // namespace

TEST_CASE("memory that a fork shares counts once, and what a child changes counts again") {
  // 5 x 160 MiB are resident; 160 are there, and 480 when each child has written to one string.
  const ChildEnd shared =
      run_child(limited_mib(forking("1", "select(undef, undef, undef, 0.6)"), 400));
  CHECK(shared.kind == Kind::kExited);
  const ChildEnd changed = run_child(limited_mib(
      forking("for ($i = 0; $i < $n; $i += 1024) { substr($x, $i, 1) = \"y\" }", "sleep 600"),
      400));
  CHECK(changed.kind == Kind::kOutOfMemory);
  CHECK(changed.memory_note.empty());
  CHECK(descendants() == 0);
}

TEST_CASE("shared memory that several processes have mapped counts once") {
  const Descriptor file = memory_file("shared");
  REQUIRE(::ftruncate(file.get(), 40 * kMib) == 0);
  void* memory = ::mmap(nullptr, 40 * kMib, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  REQUIRE(memory != MAP_FAILED);
  std::memset(memory, 1, 40 * kMib);
  // The same processes with and without it, since what a fork copies of itself differs each time.
  const Idle idle(3);
  const double with = exact_mib(idle.members);
  REQUIRE(::ftruncate(file.get(), 0) == 0);
  CHECK(exact_mib(idle.members) == Approx(with - 40.0).margin(3.0));
  ::munmap(memory, 40 * kMib);
}

TEST_CASE("a child that fills its folder is ended") {
  const TemporaryFolder folder;
  ChildSetup setup = limited("mkdir a; head -c 30000000 /dev/urandom >a/b; exec sleep 600", 60);
  setup.folder = folder.text();
  setup.limits.folder_mib = 20.0;
  CHECK(run_child(setup).kind == Kind::kOutOfDisk);
  setup = limited("head -c 10000000 /dev/urandom >c; sleep 1.2", 60);
  const TemporaryFolder roomy;
  setup.folder = roomy.text();
  setup.limits.folder_mib = 20.0;
  CHECK(run_child(setup).kind == Kind::kExited);
}
