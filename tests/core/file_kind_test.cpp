// SPDX-License-Identifier: MIT
#include "core/files/file_kind.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/files/same_file.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("A path is a file, a folder, or absent because nothing of its name exists") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "file";
  write_atomically(file, "x");
  fs::create_symlink("file", folder.path() / "link");
  fs::create_directory_symlink(folder.path(), folder.path() / "loop");
  CHECK(file_kind(file) == FileKind::kFile);
  CHECK(file_kind(folder.path()) == FileKind::kFolder);
  CHECK(file_kind(folder.path() / "link") == FileKind::kFile);
  CHECK(file_kind(folder.path() / "loop/loop") == FileKind::kFolder);
  CHECK(file_kind(folder.path() / "none") == FileKind::kAbsent);
  CHECK(file_kind(folder.path() / "none/deeper/") == FileKind::kAbsent);
  CHECK(file_kind(file / "below") == FileKind::kAbsent);
  CHECK(file_kind("") == FileKind::kAbsent);
  CHECK(has_file(file));
  CHECK_FALSE(has_file(folder.path() / "none"));
  CHECK(has_folder(folder.path()));
  CHECK(plain_file_size(file) == 1);
  CHECK_THROWS_WITH(has_file(folder.path()), Contains("is a folder, expected a file"));
  CHECK_THROWS_WITH(has_folder(file), Contains("is a file, expected a folder"));
  CHECK_THROWS_WITH(plain_file_size(folder.path() / "none"), Contains("no such file"));
}

TEST_CASE("Two paths name one file or they do not, unless nobody can tell") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "file", other = folder.path() / "other";
  write_atomically(file, "x");
  write_atomically(other, "x");
  fs::create_symlink("file", folder.path() / "link");
  fs::create_symlink("circle", folder.path() / "circle");
  CHECK(is_same_file(file, folder.path() / "link"));
  CHECK_FALSE(is_same_file(file, other));
  CHECK_FALSE(is_same_file(file, folder.path() / "none"));
  CHECK_THROWS_AS(is_same_file(file, folder.path() / "circle"), UnreadableError);
}

TEST_CASE("A link that leads nowhere is no absent file") {
  const TemporaryFolder folder;
  const fs::path link = folder.path() / "sequence.json";
  fs::create_symlink("store/5f/0c.json", link);
  CHECK_THROWS_WITH(file_kind(link), Contains("sequence.json: is a link to store/5f/0c.json, which "
                                              "is not there") &&
                                         Contains("git annex get") && Contains("dvc pull"));
  CHECK_THROWS_AS(has_file(link), DataError);
  CHECK_THROWS_AS(read_text(link), DataError);
  // Also one in the middle of a path, or with a slash behind it.
  CHECK_THROWS_WITH(file_kind(link / "labels/000000.label"), Contains("is a link to"));
  CHECK_THROWS_WITH(file_kind(link.string() + "/"), Contains("is a link to"));
  fs::create_symlink("circle", folder.path() / "circle");
  CHECK_THROWS_WITH(file_kind(folder.path() / "circle"), Contains("cannot be accessed"));
}

TEST_CASE("A folder without rights hides nothing as absent") {
  if (::geteuid() == 0) return;  // Nothing is closed to root.
  const TemporaryFolder folder;
  const fs::path closed = folder.path() / "closed";
  fs::create_directory(closed);
  fs::permissions(closed, fs::perms::none);
  CHECK_THROWS_WITH(file_kind(closed / "sequence.json"), Contains("cannot be accessed"));
  fs::permissions(closed, fs::perms::owner_all);
}

TEST_CASE("Pipes, sockets and devices are refused at once, and nobody waits for them") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "000001.bin";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(file_kind(pipe), Contains("000001.bin: is a pipe, expected a plain file"));
  CHECK_THROWS_AS(read_bytes(pipe), DataError);
  CHECK_THROWS_AS(read_piece(pipe, 0, 16), DataError);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const fs::path place = folder.path() / "socket";
  std::strncpy(address.sun_path, place.c_str(), sizeof address.sun_path - 1);
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  CHECK_THROWS_WITH(file_kind(place), Contains("is a socket"));
  ::close(socket);
  CHECK_THROWS_WITH(file_kind("/dev/zero"), Contains("is a device"));
  CHECK_THROWS_AS(read_bytes("/dev/zero"), DataError);
}

TEST_CASE(
    "What stands in a folder is listed in order, and a folder that is not there is an error") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "b");
  write_atomically(folder.path() / "a", "x");
  fs::create_symlink("nothing", folder.path() / "c");
  const std::vector<fs::path> all = entries_of(folder.path());
  REQUIRE(all.size() == 3);
  CHECK(all[0].filename() == "a");
  CHECK(all[2].filename() == "c");
  CHECK(folders_in(folder.path()) == std::vector<fs::path>{folder.path() / "b"});
  CHECK_THROWS_WITH(entries_of(folder.path() / "none"), Contains("cannot be listed"));
}

TEST_CASE("Temporary names are new each time and have a form of their own") {
  const fs::path part = new_part_name("out/table.md");
  CHECK(part.parent_path() == "out");
  CHECK(part != new_part_name("out/table.md"));
  CHECK(is_part_name(part));
  CHECK(name_of_part(part) == "table.md");
  CHECK(name_of_part(new_part_name("out/run/")) == "run");
  for (const char* other :
       {"film.mkv.part", "thesis.part", "table.md.123.part", "removals.part", ".part",
        ".raymoval-0123456789abcdef01234567.part", "a.raymoval-0123456789abcdef0123456X.part",
        "a.raymoval-0123456789abcdef0123456.part", "a.raymoval-0123456789abcdef01234567.part.gz"}) {
    CHECK_FALSE(is_part_name(other));
  }
}

TEST_CASE("What is absent or damaged may be done without, but not what cannot be read") {
  CHECK(if_whole([] { return 7; }) == 7);
  CHECK(if_whole([]() -> int { throw DataError("damaged"); }) == std::nullopt);
  CHECK_THROWS_AS(if_whole([]() -> int { throw UnreadableError("no rights"); }), UnreadableError);
  CHECK_THROWS_AS(if_whole([]() -> int { throw InternalError("a fault"); }), InternalError);
}

TEST_CASE("The parts of a file are those of its own name") {
  const TemporaryFolder folder;
  const fs::path part = new_part_name(folder.path() / "map.pcd");
  const fs::path other = new_part_name(folder.path() / "other.pcd");
  for (const fs::path& path : {part, other, folder.path() / "map.pcd"}) write_atomically(path, "x");
  CHECK(parts_of(folder.path() / "map.pcd") == std::vector{part});
  CHECK(parts_of(folder.path() / "map.pcd/") == std::vector{part});
  CHECK(parts_of(folder.path() / "none.pcd").empty());
  CHECK(parts_of(folder.path() / "nowhere/map.pcd").empty());
}

TEST_CASE("What a dead process left of a file goes when that file is made again") {
  const TemporaryFolder folder;
  const fs::path target = folder / "map.pcd", other = folder / "other.pcd";
  const pid_t child = ::fork();
  if (child == 0) {
    // It ends with its locks and without its destructors, as one that is killed.
    auto* file = new Part(new_part_file(target, 0600));
    auto* labels = new Part(new_part_folder(target));
    auto* elsewhere = new Part(new_part_file(other, 0600));
    std::ofstream(labels->place / "000000.label") << "half";
    ::_exit(file->held.valid() && labels->held.valid() && elsewhere->held.valid() ? 0 : 1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(status == 0);
  REQUIRE(entries_of(folder.path()).size() == 3);
  {
    const Part made = new_part_file(target, 0600);
    CHECK(made.held.valid());
    CHECK(entries_of(folder.path()).size() == 2);  // This one, and that of the other file.
    const Part second = new_part_file(target, 0600);
    remove_abandoned_part(made.place);  // It is in use.
    CHECK(entries_of(folder.path()).size() == 3);
  }
  const Part made = new_part_file(other, 0600);
  CHECK(fs::exists(made.place));
  CHECK(entries_of(folder.path()).size() == 3);  // The two that lost their locks just now are new.
}
