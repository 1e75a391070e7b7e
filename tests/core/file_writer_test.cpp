// SPDX-License-Identifier: MIT
#include "core/files/file_writer.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/replacements.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::TemporaryFolder;

namespace {

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// A disk with room for `bytes` in each file, for as long as it lives.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit small = before_;
    small.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &small);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

mode_t rights_of(const std::filesystem::path& path) {
  struct stat status {};
  REQUIRE(::lstat(path.c_str(), &status) == 0);
  return status.st_mode & 0777U;
}

/// A part of `target` with `content` that is on the disk.
Part written_part(const std::filesystem::path& target, std::string_view content) {
  Part part = new_part_file(target, 0666);
  REQUIRE(part.held.valid());
  REQUIRE(::write(part.held.get(), content.data(), content.size()) ==
          static_cast<ssize_t>(content.size()));
  return part;
}

}  // namespace

TEST_CASE("A file keeps what it held until all of the new content has its name") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  write_atomically(path, "before");
  FileWriter file(path);
  CHECK(file.path() == path);
  file.append("count 0, ");
  file.append("points");
  file.overwrite(6, "2");
  CHECK(read_text(path) == "before");
  file.sync();
  CHECK(read_text(path) == "before");
  file.commit();
  CHECK(read_text(path) == "count 2, points");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("A full disk is told, and what was there stays") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  write_atomically(path, "before");
  {
    const SmallDisk disk(100);
    FileWriter file(path);
    file.append(std::string(90, 'x'));
    CHECK_THROWS_WITH(file.append(std::string(90, 'x')),
                      Contains("a.txt: cannot be written") && Contains("The file is as it was"));
  }
  CHECK(read_text(path) == "before");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("A file that is replaced keeps its rights, and a new one has those of its user") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  const mode_t usual = ::umask(027);
  write_atomically(path, "new");
  ::umask(usual);
  CHECK(rights_of(path) == 0640);
  for (const mode_t rights : {0600U, 0664U, 0444U}) {
    REQUIRE(::chmod(path.c_str(), rights) == 0);
    write_atomically(path, "other");
    CHECK(rights_of(path) == rights);
  }
  if (::geteuid() != 0) return;  // Only root gives files away.
  REQUIRE(::chown(path.c_str(), 12, 34) == 0);
  write_atomically(path, "again");
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK(status.st_uid == 12);
  CHECK(status.st_gid == 34);
}

TEST_CASE("A link is replaced, unless its target is asked for") {
  const TemporaryFolder folder;
  const auto file = folder.write("elsewhere/file.txt", "before");
  const auto link = folder.path() / "link.txt";
  std::filesystem::create_symlink("elsewhere/file.txt", link);
  CHECK(std::filesystem::equivalent(output_target(link), file));
  write_atomically(output_target(link), "through");
  CHECK(std::filesystem::is_symlink(link));
  CHECK(read_text(file) == "through");
  write_atomically(link, "in place");
  CHECK_FALSE(std::filesystem::is_symlink(link));
  CHECK(read_text(file) == "through");
  CHECK(output_target(file) == file);
  CHECK(output_target(folder.path() / "none.txt") == folder.path() / "none.txt");
  std::filesystem::create_symlink("nowhere", folder.path() / "lost");
  CHECK_THROWS_WITH(output_target(folder.path() / "lost"), Contains("is a link to nowhere"));
  CHECK_THROWS_WITH(check_output_file(folder.path() / "lost", true, "lost"),
                    Contains("is a link to nowhere"));
  std::filesystem::create_symlink("elsewhere", folder.path() / "folder");
  CHECK_THROWS_WITH(output_target(folder.path() / "folder"), Contains("which is not a file"));
}

TEST_CASE("What is being made is told from what a dead process left") {
  const TemporaryFolder folder;
  const auto target = folder.path() / "map.pcd";
  const Part living = new_part_file(target, 0666);
  const Part living_folder = new_part_folder(target);
  CHECK_FALSE(take_abandoned_part(living.place).valid());
  CHECK_FALSE(take_abandoned_part(living_folder.place).valid());
  const pid_t child = ::fork();
  if (child == 0) {
    (void)::mkdir((folder.path() / "dead").c_str(), 0777);
    const Part file = new_part_file(folder.path() / "dead/map.pcd", 0666);
    const Part made = new_part_folder(folder.path() / "dead/labels");
    ::_exit(file.held.valid() && made.held.valid() ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  REQUIRE(status == 0);
  const auto left = entries_of(folder.path() / "dead");
  REQUIRE(left.size() == 2);
  for (const auto& part : left) {
    const Descriptor lock = take_abandoned_part(part);
    CHECK(lock.valid());
    CHECK_FALSE(take_abandoned_part(part).valid());  // `lock` holds it.
  }
  // Parts of another machine, whose state is unknown, and parts of another name are kept.
  std::string other = left[0].string();
  const std::size_t digit = other.rfind('-') + 1;
  other[digit] = other[digit] == 'a' ? 'b' : 'a';
  std::filesystem::rename(left[0], other);
  CHECK_FALSE(take_abandoned_part(other).valid());
  CHECK_FALSE(take_abandoned_part(folder.write("mine.part", "x")).valid());
}

TEST_CASE("Several files and folders get their names together") {
  const TemporaryFolder folder;
  const auto kept = folder.write("kept.txt", "before");
  const auto labels = folder.write("labels/1.label", "before").parent_path();
  Part label_part = new_part_folder(labels);
  write_atomically(label_part.place / "2.label", "after");
  {
    Replacements all;
    all.add(written_part(kept, "after"), kept);
    all.add(std::move(label_part), labels);
    all.add(written_part(folder.path() / "new.txt", "after"), folder.path() / "new.txt");
    CHECK(read_text(kept) == "before");
    all.commit();
  }
  CHECK(read_text(kept) == "after");
  CHECK(read_text(folder.path() / "new.txt") == "after");
  CHECK(entries_of(labels) == std::vector{labels / "2.label"});
  CHECK(files_in(folder.path()) == 3);
}

TEST_CASE("If one of several files cannot have its name, none has changed") {
  const TemporaryFolder folder;
  const auto kept = folder.write("kept.txt", "before");
  const auto fresh = folder.path() / "new.txt";
  const auto labels = folder.write("labels/1.label", "before").parent_path();
  {
    Replacements all;
    all.add(written_part(kept, "after"), kept);
    all.add(written_part(fresh, "after"), fresh);
    all.add(new_part_folder(labels), labels);
    (void)folder.write("taken.txt/somebody's", "work");
    all.add(written_part(folder.path() / "taken.txt", "after"), folder.path() / "taken.txt");
    CHECK_THROWS_WITH(all.commit(), Contains("taken.txt: cannot be written (Is a directory)") &&
                                        Contains("Nothing was changed"));
  }
  CHECK(read_text(kept) == "before");
  CHECK(read_text(labels / "1.label") == "before");
  CHECK(read_text(folder.path() / "taken.txt/somebody's") == "work");
  CHECK_FALSE(is_there(fresh));
  CHECK(files_in(folder.path()) == 3);
}
