// SPDX-License-Identifier: MIT
// Objects that move at the time of a scan, by the side file of a sequence.
#include <catch2/catch.hpp>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;
using Catch::Matchers::Contains;

namespace {

constexpr std::uint32_t word(std::uint32_t instance, std::uint32_t id) {
  return (instance << 16U) | id;
}

/// Four scans of four points: the road, a car that leaves in scan 2, a person who stops in scan 1
/// and continues in scan 3, and an arm that is not in the side file.
void write_street(const TemporaryFolder& folder) {
  std::string poses;
  for (int i = 0; i < 4; ++i) {
    const std::string name = "00000" + std::to_string(i);
    folder.write("velodyne/" + name + ".bin",
                 floats({5, 0, 0, 1, 6, 0, 0, 1, 7, 0, 0, 1, 8, 0, 0, 1}));
    folder.write("labels/" + name + ".label",
                 words({40, word(7, 252), word(9, 254), word(0, 259)}));
    poses += kIdentityRow;
  }
  folder.write("poses.txt", poses);
  folder.write("sequence.json", R"({"poses_are_lidar": true, "labels": {"ignored": [0, 1]}})");
  folder.write("movers.json", R"([
    {"instance": 7, "label": 252, "kind": "car", "moves": true, "when": [
      {"scan": 0, "time_s": 0, "state": "stands", "at": [0, 0, 0]},
      {"scan": 2, "time_s": 0.2, "state": "moves", "at": [0, 0, 0]}]},
    {"instance": 9, "label": 254, "kind": "pedestrian", "moves": true, "when": [
      {"scan": 0, "time_s": 0, "state": "moves", "at": [0, 0, 0]},
      {"scan": 1, "time_s": 0.1, "state": "stands", "at": [0, 0, 0]},
      {"scan": 3, "time_s": 0.3, "state": "moves", "at": [0, 0, 0]}]}])");
}

SequenceOptions moving_now() {
  SequenceOptions options;
  options.label_rule = kMovingNow;
  return options;
}

/// '1' for each point that moves.
std::string moving(const Sequence& sequence, std::size_t scan) {
  std::string text;
  for (const std::uint32_t label : sequence.labels->labels(sequence.scans->load(scan))) {
    text += sequence.label_rule.classify(label) == LabelClass::kMoving ? '1' : '0';
  }
  return text;
}

}  // namespace

TEST_CASE("what stands in a scan does not move now", "[semantickitti]") {
  const TemporaryFolder folder;
  write_street(folder);
  const Sequence ever = open_sequence(folder.text(), {});
  for (std::size_t scan = 0; scan < 4; ++scan) CHECK(moving(ever, scan) == "0111");
  const Sequence now = open_sequence(folder.text(), moving_now());
  CHECK(moving(now, 0) == "0011");
  CHECK(moving(now, 1) == "0001");
  CHECK(moving(now, 2) == "0101");
  CHECK(moving(now, 3) == "0111");
  CHECK(now.labels->labels(now.scans->load(1)) ==
        std::vector<std::uint32_t>{40, word(7, 10), word(9, 30), word(0, 259)});
  CHECK(now.record().label_rule->name == "moving-now");
  CHECK(now.record().label_rule->ignored == std::vector<std::uint16_t>{0, 1});
  // Frames go by their numbers.
  SequenceOptions some = moving_now();
  some.frames = parse_frame_range("2:3");
  CHECK(moving(open_sequence(folder.text(), some), 0) == "0101");
}

TEST_CASE("data that does not say who moves when has no such rule", "[semantickitti]") {
  const TemporaryFolder folder;
  write_street(folder);
  const auto error = [&](const std::string& movers) {
    folder.write("movers.json", movers);
    return message_of<ConfigurationError>([&] { open_sequence(folder.text(), moving_now()); });
  };
  CHECK_THAT(error(R"([{"when": []}])"), Contains("movers.json") && Contains("instance"));
  CHECK_THAT(error(R"([{"instance": 1, "when": [{"scan": 0, "state": "flies"}]}])"),
             Contains("state"));
  CHECK_THAT(error(R"([{"instance": 1, "when": [{"scan": 3, "state": "moves"},
                                                {"scan": 3, "state": "stands"}]}])"),
             Contains("a later scan"));
  CHECK_THAT(error(R"([{"instance": 1}, {"instance": 1}])"), Contains("no other mover"));
  std::filesystem::remove(folder / "movers.json");
  CHECK_THAT(message_of<DataError>([&] { open_sequence(folder.text(), moving_now()); }),
             Contains("movers.json: is missing") && Contains("leave the rule out"));
  std::filesystem::remove_all(folder / "labels");
  CHECK_THAT(message_of<UsageError>([&] { open_sequence(folder.text(), moving_now()); }),
             Contains("it has no labels"));
  CHECK_THAT(message_of<UsageError>([&] { open_sequence("street", moving_now()); }),
             Contains("have no times of motion"));
}
