// SPDX-License-Identifier: MIT
// What leaves a family, and what does not belong to it.
#include "core/process/process_family.h"

#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/core/shell_children.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;
using Kind = ChildEnd::Kind;

namespace {

/// Starts a daemon that has another parent, session and environment than the script, and continues
/// when it runs.
std::string daemon_in(const TemporaryFolder& folder) {
  const std::string ready = "'" + folder.text() + "/ready'";
  return "(env -i setsid sh -c '" + nap() + " & echo > \"$0\"; wait' " + ready +
         " >/dev/null 2>&1 &); while [ ! -e " + ready + " ]; do sleep 0.01; done; ";
}

std::string until_there(const TemporaryFolder& folder, const std::string& name) {
  return "while [ ! -e '" + folder.text() + "/" + name + "' ]; do sleep 0.01; done; ";
}

pid_t own_child(const std::string& script) {
  const pid_t child = ::fork();
  if (child == 0) ::execl("/bin/sh", "sh", "-c", script.c_str(), nullptr);
  return child;
}

}  // namespace

TEST_CASE("a daemon without the family's environment ends with the child, however that ends") {
  const WakeAll after;
  for (const auto& [last, kind, code] : {std::tuple("exit 4", Kind::kExited, 4),
                                         std::tuple("kill -KILL $$", Kind::kSignalled, SIGKILL),
                                         std::tuple("sleep 600", Kind::kTimeout, 0)}) {
    const TemporaryFolder folder;
    const ChildEnd end =
        run_child(limited(daemon_in(folder) + last, kind == Kind::kTimeout ? 1 : 60));
    CHECK(end.kind == kind);
    CHECK(end.code == code);
    CHECK(napping().empty());
  }
}

TEST_CASE("daemons that a daemon goes on starting end, too") {
  const WakeAll after;
  const TemporaryFolder folder;
  // Each link starts the next one, in a session of its own and without environment, and ends.
  const std::string link =
      folder.write("link.sh", nap() + " & env -i setsid sh \"$0\" & sleep 0.001\n").string();
  CHECK(run_child(limited("env -i setsid sh '" + link + "' & sleep 0.1; exit 0", 60)).code == 0);
  CHECK(napping().empty());
}

TEST_CASE("children that are not of the family are neither ended nor waited for") {
  const WakeAll after;
  const TemporaryFolder folder;
  const pid_t sleeper = own_child("exec " + nap());
  const pid_t ended = own_child("exit 7");
  REQUIRE(napping_become(1));
  // While the family runs, this process is also the foster parent of processes of other children.
  ChildEnd end;
  std::thread family([&] {
    end = run_child(limited(": > '" + folder.text() + "/begun'; " + until_there(folder, "go"), 60));
  });
  while (!std::filesystem::exists(folder / "begun")) std::this_thread::yield();
  const pid_t leaver = own_child("setsid " + nap() + " & exit 8");
  int status = 0;
  CHECK(::waitpid(leaver, &status, 0) == leaver);
  CHECK(WEXITSTATUS(status) == 8);
  REQUIRE(napping_become(2));
  folder.write("go", "");
  family.join();
  CHECK(end.kind == Kind::kExited);
  CHECK(napping().size() == 2);
  CHECK(::waitpid(ended, &status, 0) == ended);
  CHECK(WEXITSTATUS(status) == 7);
  for (const pid_t left : napping()) {
    ::kill(left, SIGKILL);
    CHECK(::waitpid(left, &status, 0) == left);  // The leaver's has become a child of this process.
  }
  (void)sleeper;
}

TEST_CASE("families that run at once leave each other alone") {
  const WakeAll after;
  const TemporaryFolder folder, left;
  ChildEnd end;
  std::thread first([&] {
    end = run_child(limited(
        nap() + " & : > '" + folder.text() + "/begun'; " + until_there(folder, "go") + "exit 3",
        60));
  });
  while (!std::filesystem::exists(folder / "begun")) std::this_thread::yield();
  CHECK(napping_become(1));
  for (int i = 0; i < 5; ++i) CHECK(run_child(shell("exit 5")).code == 5);
  CHECK(napping().size() == 1);
  // Processes of unknown family are ended with the last family.
  CHECK(run_child(limited(daemon_in(left) + "exit 6", 60)).code == 6);
  folder.write("go", "");
  first.join();
  CHECK(end.code == 3);
  CHECK(napping().empty());
}

TEST_CASE("a child ends with the process that watches it") {
  const WakeAll after;
  const ChildSetup setup = shell("exec " + nap());
  const pid_t watcher = ::fork();
  if (watcher == 0) {
    run_child(setup);
    ::_exit(0);
  }
  REQUIRE(napping_become(1));
  ::kill(watcher, SIGKILL);
  CHECK(::waitpid(watcher, nullptr, 0) == watcher);
  CHECK(napping_become(0));
}

TEST_CASE("children are found with and without a kernel that lists them") {
  const WakeAll after;
  const pid_t child = own_child("exec " + nap());
  REQUIRE(napping_become(1));
  std::vector<pid_t> listed = children_of(::getpid());
  std::vector<pid_t> asked = children_by_parent(::getpid());
  std::sort(listed.begin(), listed.end());
  std::sort(asked.begin(), asked.end());
  CHECK(std::count(asked.begin(), asked.end(), child) == 1);
  CHECK(listed == asked);
  CHECK(process_state(child).parent == ::getpid());
  ::kill(child, SIGKILL);
  CHECK(::waitpid(child, nullptr, 0) == child);
  CHECK(process_state(child).has_ended());
}
