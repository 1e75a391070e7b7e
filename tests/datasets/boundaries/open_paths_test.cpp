// SPDX-License-Identifier: MIT
// Paths of sequences, and the messages for paths near a sequence.
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/layouts.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/open_folders.h"
#include "tests/datasets/written_cloud.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

void write_drive(const TemporaryFolder& folder, const std::string& at) {
  folder.write(at + "/velodyne/000000.bin", floats({1, 2, 3, 4}));
  folder.write(at + "/poses.txt", kIdentityRow);
  folder.write(at + "/calib.txt", "Tr: " + kIdentityRow);
}

}  // namespace

TEST_CASE("a folder of scans inside a sequence leads to the sequence", "[layouts]") {
  const TemporaryFolder folder;
  write_drive(folder, "drive");
  const std::string drive = folder.text() + "/drive";
  for (const char* part : {"/velodyne", "/velodyne/"}) {
    check_says(open_error(drive + part),
               {"holds scans only; the sequence they belong to is " + drive + "."});
  }
  check_says(open_error(drive + "/velodyne/000000.bin"),
             {"is a scan, expected the folder of its sequence: " + drive + "."});
  check_says(open_error(drive + "/poses.txt"), {"is a file, expected a folder.", "Known are: "});
  // With its own poses it is a sequence, also if an option names them.
  SequenceOptions options;
  options.poses = drive + "/poses.txt";
  CHECK(open_sequence(drive + "/velodyne", options).layout == "files");
  folder.write("drive/velodyne/poses.txt", kIdentityRow);
  CHECK(open_sequence(drive + "/velodyne", {}).layout == "files");
  // Scans below a folder of another name belong to nothing.
  write_cloud(folder / "loose.bin", {{1, 2, 3}});
  check_says(open_error(folder.text()), {"there is no pose file 'poses.txt'", "found no .txt"});
}

TEST_CASE("a name near that of a scene is told", "[layouts]") {
  check_says(open_error("stret"), {"stret: no such folder.", "Did you mean the scene 'street'?"});
  CHECK_THAT(open_error("/none/at/all"), !Catch::Contains("Did you mean"));
}

TEST_CASE("scenes are told from folders", "[layouts]") {
  const TemporaryFolder folder;
  write_drive(folder, "street");
  const std::string drive = folder.text() + "/street";
  CHECK(is_scene("street"));
  CHECK_FALSE(is_scene(drive));
  CHECK(is_at_hand("street"));
  CHECK(is_at_hand(drive));
  CHECK(sequence_name("street", {}) == "street");
  CHECK(sequence_name(drive, {}) == "street");
  SequenceOptions options;
  options.name = "mine";
  CHECK(sequence_name("/none", options) == "mine");
  const auto names = scene_names();
  for (const char* name : {"street", "town"}) {
    CHECK(std::find(names.begin(), names.end(), name) != names.end());
  }
  check_says(scene_or_folder("street", folder.path()),
             {"street: is a scene and also a folder here; write ./street for the folder"});
  CHECK(scene_or_folder("town", folder.path()).empty());
  CHECK(scene_or_folder(drive, folder.path()).empty());
  CHECK_NOTHROW(check_not_both(drive));
}

TEST_CASE("a layout of a test is asked after scenes and before folders", "[layouts]") {
  Layout mine;
  mine.name = "files";
  check_says(message_of<UsageError>([&] { register_layout(mine); }),
             {"already a layout 'files'", "another name"});
  mine.name = "one of a test";
  mine.expected = "nothing else";
  mine.forms = {{"test:", "a test"}};
  mine.recognise = [](Layout::Path path) { return path == "test:"; };
  register_layout(mine);
  std::vector<std::string> names;
  for (const Layout& layout : layouts()) names.push_back(layout.name);
  const auto at = std::find(names.begin(), names.end(), mine.name) - names.begin();
  for (std::size_t i = 0; i < names.size(); ++i) {
    CHECK((static_cast<long>(i) < at) == std::next(layouts().begin(), long(i))->scenes.has_value());
  }
  REQUIRE(recognised_layout("test:") != nullptr);
  CHECK(recognised_layout("test:")->name == mine.name);
  CHECK(recognised_layout("street")->name == "simulated");
  CHECK(recognised_layout("/none") == nullptr);
}

TEST_CASE("a .bin file has no room for float64", "[cloud]") {
  check_says(message_of<UsageError>([] { check_coordinates("map.bin", Coordinates::kDouble); }),
             {"map.bin: a .bin file holds float32 numbers only"});
  CHECK_NOTHROW(check_coordinates("map.bin", Coordinates::kFloat));
  CHECK_NOTHROW(check_coordinates("map.pcd", Coordinates::kDouble));
}
