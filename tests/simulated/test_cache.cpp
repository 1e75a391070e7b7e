// SPDX-License-Identifier: MIT
// The cache of simulated scenes: what is in it is whole, or is made again.
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_lock.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "datasets/simulation/scene/simulated.h"
#include "tests/datasets/temporary_folder.h"
#include "tests/simulated/scenes.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using raymoval::simulated::small_town;
using raymoval::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

/// The text of a log.
class Log {
 public:
  Log() : file_(std::tmpfile()), progress_(ProgressStyle::kLog, file_) {}
  ~Log() { std::fclose(file_); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  Progress* progress() { return &progress_; }
  /// Read by a descriptor of its own, so that others may go on writing.
  std::string text() {
    std::fflush(file_);
    std::ifstream written("/proc/self/fd/" + std::to_string(::fileno(file_)));
    return {std::istreambuf_iterator<char>(written), {}};
  }

 private:
  std::FILE* file_;
  Progress progress_;
};

/// All names and contents below a folder.
std::string content_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  ContentHasher hasher;
  for (const fs::path& file : files) {
    hasher.add(file.lexically_relative(folder).string());
    hasher.add(read_text(file));
  }
  return hasher.digest();
}

/// Runs `deed` in a process that then ends as if killed: nothing is cleaned up.
void in_killed_process(const std::function<void()>& deed) {
  const pid_t child = ::fork();
  if (child == 0) {
    deed();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(status == 0);
}

}  // namespace

TEST_CASE("A scene of the cache that is not what was written there is made again, and said",
          "[slow]") {
  const TemporaryFolder scratch;
  const fs::path folder = cached_simulation(small_town(), scratch.text(), 2, nullptr);
  const std::string whole = content_of(folder);
  const fs::path scan = folder / "velodyne/000001.bin";
  const std::vector<std::pair<std::string, std::function<void()>>> harms = {
      {"velodyne/ has 2 scans, written were 3", [&] { fs::remove(scan); }},
      {"labels/ has 2 scans, written were 3", [&] { fs::remove(folder / "labels/000002.label"); }},
      {"velodyne/ has 4 scans, written were 3",
       [&] { fs::copy_file(scan, folder / "velodyne/000003.bin"); }},
      {"sequence.json is missing", [&] { fs::remove(folder / "sequence.json"); }},
      // As earlier versions left it.
      {"manifest.json is missing", [&] { fs::remove(folder / "manifest.json"); }},
      {"manifest.json is damaged",
       [&] {
         fs::resize_file(folder / "manifest.json", 0);
         std::ofstream(folder / "manifest.json") << "{}";
       }},
      {"velodyne/ is missing", [&] { fs::remove_all(folder / "velodyne"); }},
      {"manifest.json is missing",
       [&] {
         fs::remove_all(folder);
         fs::create_directory(folder);
       }},
  };
  for (const auto& [problem, harm] : harms) {
    harm();
    Log log;
    CHECK(cached_simulation(small_town(), scratch.text(), 2, log.progress()) == folder);
    CHECK_THAT(log.text(), Contains(problem));
    CHECK_THAT(log.text(), Contains("it is simulated again"));
    CHECK(content_of(folder) == whole);
    CHECK(entries_of(folder.parent_path()).size() == 1);  // Neither the old nor a lock is left.
  }
  Log log;
  CHECK(cached_simulation(small_town(), scratch.text(), 2, log.progress()) == folder);
  CHECK(log.text().empty());
}

TEST_CASE("What a killed process left goes, and what may be alive or another's stays") {
  const TemporaryFolder scratch;
  const fs::path cache = scratch / "simulated";
  fs::create_directories(cache);
  const fs::path target = cache / "town-0123456789abcdef";
  in_killed_process([&] {
    auto* part = new Part(new_part_folder(target));
    std::ofstream(part->place / "half") << "written";
  });
  REQUIRE(entries_of(cache).size() == 1);
  const Part alive = new_part_folder(target);
  // Made under another kernel: its lock cannot be asked here.
  std::string elsewhere = new_part_name(target).string();
  char& digit = elsewhere[elsewhere.rfind("raymoval-") + 9];
  digit = digit == '0' ? '1' : '0';
  // Names and age alone are no proof: earlier versions, other machines and users have such files.
  const std::vector<fs::path> others = {
      cache / "town-0123456789abcdef.1.0.part", cache / "thesis.part", elsewhere,
      cache / "town-0123456789abcdef.raymoval-0123456789abcdef.part"};
  for (const fs::path& other : others) {
    fs::create_directory(other);
    fs::last_write_time(other, fs::file_time_type::clock::now() - std::chrono::hours(480));
  }
  std::ofstream(cache / "film.mkv.part") << "film";
  std::ofstream(cache / "dead.lock") << "process 1 on somewhere\n";
  FileLock held(cache / "held.lock");
  REQUIRE(held.take(FileLock::Mode::kExclusive) == FileLock::State::kHeld);

  const fs::path made = cached_simulation(small_town(), scratch.text(), 1, nullptr);
  CHECK(fs::is_directory(alive.place));
  for (const fs::path& other : others) CHECK(fs::is_directory(other));
  CHECK(fs::exists(cache / "film.mkv.part"));
  CHECK(fs::exists(cache / "held.lock"));
  CHECK(entries_of(cache).size() == 1 + others.size() + 3);  // alive, the film, the lock

  // A scene that is there already is a use of the cache, too.
  in_killed_process([&] { new Part(new_part_folder(target)); });
  std::ofstream(cache / "dead.lock") << "process 1 on somewhere\n";
  CHECK(cached_simulation(small_town(), scratch.text(), 1, nullptr) == made);
  CHECK(entries_of(cache).size() == 1 + others.size() + 3);
}

TEST_CASE("Who asks for a scene that another one makes waits for it, and may be stopped") {
  const TemporaryFolder scratch;
  const fs::path folder = cached_simulation(small_town(), scratch.text(), 1, nullptr);
  fs::remove(folder / "poses.txt");
  const fs::path lock_file = folder.string() + ".lock";
  auto other = std::make_unique<FileLock>(lock_file);
  REQUIRE(other->take(FileLock::Mode::kExclusive) == FileLock::State::kHeld);
  std::atomic<bool> cancel = true;
  CHECK_THROWS_AS(cached_simulation(small_town(), scratch.text(), 1, nullptr, &cancel), Cancelled);
  cancel = false;
  Log log;
  std::atomic<bool> done = false;
  std::thread asker([&] {
    cached_simulation(small_town(), scratch.text(), 1, log.progress(), &cancel);
    done = true;
  });
  const std::string waiting = "waiting for process " + std::to_string(::getpid());
  while (!done && log.text().find(waiting) == std::string::npos) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK_FALSE(done);
  other.reset();
  asker.join();
  CHECK_THAT(log.text(), Contains(waiting));
  CHECK(fs::exists(folder / "poses.txt"));
  CHECK_FALSE(fs::exists(lock_file));
}
