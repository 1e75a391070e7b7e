// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/process/child_process.h"
#include "core/process/proc_files.h"

namespace raymoval::test {

/// A child that is a shell script of a line or two, so that all it does can be seen.
inline ChildSetup shell(const std::string& script) {
  ChildSetup setup;
  setup.program = "/bin/sh";
  setup.arguments = {"sh", "-c", script};
  setup.environment = {{"RAYMOVAL_TEST_TOKEN", std::to_string(::getpid())}};
  return setup;
}

inline ChildSetup limited(const std::string& script, double seconds) {
  ChildSetup setup = shell(script);
  setup.limits.seconds = seconds;
  return setup;
}

/// How many processes run that have the environment of a child of this test.
inline int descendants() {
  const std::string token = "RAYMOVAL_TEST_TOKEN=" + std::to_string(::getpid());
  int count = 0;
  for (const pid_t process : all_processes()) {
    std::ifstream file(proc_folder(process) / "environ");
    for (std::string variable; std::getline(file, variable, '\0');) count += variable == token;
  }
  return count;
}

/// "sleep N" for a time that only this test sleeps: more than half an hour.
inline std::string nap() {
  return "sleep 2000." + std::to_string(::getpid());
}

/// The processes that sleep for this time, with any environment.
inline std::vector<pid_t> napping() {
  std::vector<pid_t> found;
  for (const pid_t process : all_processes()) {
    std::ifstream file(proc_folder(process) / "cmdline");
    std::string line;
    for (std::string word; std::getline(file, word, '\0');)
      line += (line.empty() ? "" : " ") + word;
    if (line == nap()) found.push_back(process);
  }
  return found;
}

/// Waits until `count` processes sleep; gives up after half a minute. @return whether they do
inline bool napping_become(std::size_t count) {
  for (int i = 0; i < 1500 && napping().size() != count; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return napping().size() == count;
}

/// Ends all sleeping processes before the next test, also after a failure.
struct WakeAll {
  ~WakeAll() {
    for (const pid_t process : napping()) ::kill(process, SIGKILL);
  }
};

}  // namespace raymoval::test
