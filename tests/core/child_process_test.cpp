// SPDX-License-Identifier: MIT
#include "core/process/child_process.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "core/files/descriptor_io.h"
#include "tests/core/shell_children.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;
using Catch::Matchers::Contains;
using Kind = ChildEnd::Kind;

TEST_CASE("a child ends with its exit code and the end of what it printed") {
  const ChildEnd end = run_child(shell("printf out; printf err >&2; exit 3"));
  CHECK(end.kind == Kind::kExited);
  CHECK(end.code == 3);
  CHECK(end.output_tail == "outerr");  // No newline is needed.
  const ChildEnd signalled = run_child(shell("kill -SEGV $$"));
  CHECK(signalled.kind == Kind::kSignalled);
  CHECK(signal_text(signalled.code) == "signal 11 (Segmentation fault)");
}

TEST_CASE("of much output the last 4 KiB are kept, from the start of a line where there is one") {
  // 1 MiB without a newline, then with lines of ten bytes: 4096 bytes hold 409 of these.
  const std::string one = run_child(shell("yes | head -c 1048576 | tr -d '\\n'")).output_tail;
  CHECK(one == std::string(4096, 'y'));
  const std::string lines = run_child(shell("yes 123456789 | head -n 100000")).output_tail;
  CHECK(lines.size() == 4090);
  CHECK_THAT(lines, Catch::StartsWith("123456789\n") && Catch::EndsWith("123456789\n"));
}

TEST_CASE("a child gets the environment, folder and descriptors that it is meant to have") {
  const test::TemporaryFolder folder;
  const Descriptor given = memory_file("given");
  REQUIRE(write_at(given.get(), "handed over", 0));
  const int inherited = ::dup(given.get());  // Without close-on-exec.
  ChildSetup setup = shell("pwd; echo $WORD; cat /dev/fd/5; echo; cat; ls /proc/self/fd | wc -l");
  setup.folder = folder.text();
  setup.environment.emplace_back("WORD", "a word");
  setup.descriptors = {{given.get(), 5}};
  const std::string output = run_child(setup).output_tail;
  ::close(inherited);
  // Standard input is empty. Open are 0, 1, 2, 5 and the folder that ls reads.
  CHECK(output ==
        std::filesystem::canonical(folder.text()).string() + "\na word\nhanded over\n5\n");
}

TEST_CASE("what this process blocks or ignores is not the child's") {
  sigset_t blocked, before;
  ::sigemptyset(&blocked);
  ::sigaddset(&blocked, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const auto handler = std::signal(SIGUSR2, SIG_IGN);
  const ChildEnd one = run_child(shell("kill -USR1 $$; exit 0"));
  const ChildEnd two = run_child(shell("kill -USR2 $$; exit 0"));
  std::signal(SIGUSR2, handler);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  CHECK((one.kind == Kind::kSignalled && one.code == SIGUSR1));
  CHECK((two.kind == Kind::kSignalled && two.code == SIGUSR2));
}

TEST_CASE("a child that cannot be started is told with the system's reason") {
  ChildSetup setup = shell("true");
  setup.program = "/no/such/program";
  const ChildEnd end = run_child(setup);
  CHECK(end.kind == Kind::kNotStarted);
  CHECK(end.code == ENOENT);
  CHECK_THAT(not_started_text(EAGAIN), Contains("Resource temporarily unavailable"));
  setup = shell("true");
  setup.folder = "/no/such/folder";
  CHECK(run_child(setup).kind == Kind::kNotStarted);
}

TEST_CASE("a child that closes its descriptors is waited for all the same") {
  const ChildEnd end = run_child(shell("exec <&- >&- 2>&-; sleep 0.2; exit 5"));
  CHECK(end.kind == Kind::kExited);
  CHECK(end.code == 5);
  CHECK(run_child(limited("exec <&- >&- 2>&-; sleep 600", 0.3)).kind == Kind::kTimeout);
  CHECK(descendants() == 0);
}

TEST_CASE("a child that ignores SIGTERM ends when its time is over") {
  const ChildEnd end =
      run_child(limited("trap '' TERM HUP INT; echo begun; while :; do sleep 0.05; done", 1.5));
  CHECK(end.kind == Kind::kTimeout);
  CHECK(end.output_tail == "begun\n");
  CHECK(descendants() == 0);
}

TEST_CASE("all that a forking child has started is gone after a limit") {
  // Each link of four chains starts the next one in a session of its own and ends at once.
  const test::TemporaryFolder folder;
  const std::string link = folder.write("link.sh", "setsid sh \"$0\" & sleep 0.001\n").string();
  const std::string chains =
      "for i in 1 2 3 4; do sh '" + link + "' & done; while :; do sleep 0.01; done";
  CHECK(run_child(limited(chains, 0.5)).kind == Kind::kTimeout);
  CHECK(descendants() == 0);
}

TEST_CASE("a double fork does not get away, whether the child ends or is ended") {
  const test::TemporaryFolder folder;
  const std::string ready = "'" + folder.text() + "/ready'";
  // The script continues when the daemon has left its session.
  const std::string daemon = "(setsid sh -c 'setsid sleep 600 & echo > \"$0\"; wait' " + ready +
                             " >/dev/null 2>&1 &); while [ ! -e " + ready +
                             " ]; do sleep 0.01; done; ";
  CHECK(run_child(limited(daemon + "sleep 600", 0.3)).kind == Kind::kTimeout);
  CHECK(descendants() == 0);
  std::filesystem::remove(folder / "ready");
  CHECK(run_child(shell(daemon + "exit 4")).code == 4);
  CHECK(descendants() == 0);
  // It counts as the child's memory, too: 150 MB of zeros in a program that holds them.
  ChildSetup setup = shell(
      "(setsid sh -c 'head -c 200000000 /dev/zero | tail -c 150000000 | "
      "sleep 600' &); sleep 600");
  setup.limits = {60.0, 100.0};
  const ChildEnd end = run_child(setup);
  CHECK(end.kind == Kind::kOutOfMemory);
  CHECK(end.largest_mib > 100.0);
  CHECK(descendants() == 0);
}

TEST_CASE("a cancelled child ends with all that it has started") {
  const std::atomic<bool> cancel{true};
  ChildSetup setup = shell("sleep 600 & sleep 600");
  setup.cancel = &cancel;
  CHECK(run_child(setup).kind == Kind::kCancelled);
  CHECK(descendants() == 0);
}
