// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

/// Two sensors of three scans of three points: unlabelled, static, moving.
void write_root(const TemporaryFolder& folder) {
  for (const char* part : {"train.txt", "val.txt", "test.txt"}) folder.write(part, "0\n");
  for (const std::string sensor : {"Avia", "Ouster"}) {
    for (int i = 0; i < 3; ++i) {
      const std::string name = "/00000" + std::to_string(i);
      folder.write(sensor + "/velodyne" + name + ".bin",
                   floats({static_cast<float>(i), 2, 3, 0.5F, 5, 6, 7, 0.25F, 8, 9, 9, 0.5F}));
      folder.write(sensor + "/labels" + name + ".label", words({0, 9, 251}));
    }
    folder.write(sensor + "/calib.txt", "Tr: " + kIdentityRow);
    folder.write(sensor + "/poses.txt", kIdentityRow + kIdentityRow + kIdentityRow);
  }
}

void check_moves_by_its_labels(const Sequence& sequence) {
  CHECK(sequence.layout == "helimos");
  CHECK(sequence.name == "Ouster");
  CHECK(sequence.scans->size() == 3);
  REQUIRE(sequence.labels);
  CHECK(sequence.labels->labels(sequence.scans->load(1)) == std::vector<std::uint32_t>{0, 9, 251});
  for (std::uint32_t label = 251; label <= 259; ++label) {
    CHECK(sequence.label_rule.classify(label) == LabelClass::kMoving);
  }
  for (const std::uint32_t label : {1U, 9U, 10U, 250U, 260U}) {
    CHECK(sequence.label_rule.classify(label) == LabelClass::kStatic);
  }
  CHECK(sequence.label_rule.classify(0) == LabelClass::kIgnored);
  CHECK(sequence.label_rule.class_name(9) == "static");
  CHECK(sequence.label_rule.class_name(251) == "moving");
  CHECK(sequence.label_rule.class_name(254) == "moving-person");
}

}  // namespace

TEST_CASE("a sensor of a HeLiMOS root is opened by its name and by its folder", "[helimos]") {
  const TemporaryFolder folder;
  write_root(folder);
  check_moves_by_its_labels(open_sequence(folder.text() + ":Ouster", {}));
  check_moves_by_its_labels(open_sequence(folder.text() + "/Ouster", {}));
  check_moves_by_its_labels(open_sequence(folder.text() + "/Ouster/", {}));
}

TEST_CASE("a HeLiMOS root says which sensors it has", "[helimos]") {
  const TemporaryFolder folder;
  write_root(folder);
  for (const std::string& path : {folder.text(), folder.text() + ":Velodyne"}) {
    check_says(message_of<UsageError>([&] { (void)open_sequence(path, {}); }),
               {"Avia, Ouster", folder.text() + ":Avia"});
  }
}

TEST_CASE("a label rule of the user stands above that of HeLiMOS", "[helimos]") {
  const TemporaryFolder folder;
  write_root(folder);
  folder.write("rule.json", R"({"moving": [9]})");
  SequenceOptions options;
  options.label_rule = folder / "rule.json";
  const Sequence sequence = open_sequence(folder.text() + ":Ouster", options);
  CHECK(sequence.label_rule.classify(9) == LabelClass::kMoving);
  CHECK(sequence.label_rule.classify(251) == LabelClass::kStatic);
  folder.write("Ouster/sequence.json", R"({"labels": {"ignored": []}})");
  const Sequence with_file = open_sequence(folder.text() + ":Ouster", {});
  CHECK(with_file.label_rule.classify(0) == LabelClass::kStatic);
  CHECK(with_file.label_rule.classify(251) == LabelClass::kMoving);
}
