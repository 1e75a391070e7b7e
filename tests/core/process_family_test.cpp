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

std::string until_there(const TemporaryFolder& folder, const std::string& name) {
  return "while [ ! -e '" + folder.text() + "/" + name + "' ]; do sleep 0.01; done; ";
}

pid_t own_child(const std::string& script) {
  const pid_t child = ::fork();
  if (child == 0) ::execl("/bin/sh", "sh", "-c", script.c_str(), nullptr);
  return child;
}

}  // namespace

TEST_CASE("children that are not of the family are neither ended nor waited for") {
  const WakeAll after;
  const pid_t sleeper = own_child("exec " + nap());
  const pid_t ended = own_child("exit 7");
  REQUIRE(napping_become(1));
  CHECK(run_child(shell("exit 3")).code == 3);
  CHECK(napping().size() == 1);
  int status = 0;
  CHECK(::waitpid(ended, &status, 0) == ended);
  CHECK(WEXITSTATUS(status) == 7);
  ::kill(sleeper, SIGKILL);
  CHECK(::waitpid(sleeper, &status, 0) == sleeper);
}

TEST_CASE("families that run at once leave each other alone") {
  const WakeAll after;
  const TemporaryFolder folder;
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
