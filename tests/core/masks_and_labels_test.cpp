// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "core/error.h"
#include "core/scan/label_rule.h"
#include "core/scan/mask_store.h"
#include "core/scan/range_limits.h"
#include "core/scan/scan_source.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::json;

TEST_CASE("Masks of any size come back as they were, from memory and from a file") {
  const test::TemporaryFolder folder;
  const bool in_file = GENERATE(false, true);
  std::mt19937 random(5);
  const std::vector<std::size_t> sizes = {0, 1, 63, 64, 65, 128, 1000};
  const std::size_t scans = sizes.size() + 1;
  MaskStore store(in_file ? ScanSpool(scans, folder.path() / "map.pcd", "masks")
                          : ScanSpool(scans));
  std::vector<Mask> masks;
  std::size_t removed = 0;
  for (std::size_t scan = 0; scan < sizes.size(); ++scan) {
    Mask mask(sizes[scan]);
    for (auto& value : mask) value = random() % 2;
    if (!mask.empty()) mask.back() = 1;
    CHECK_FALSE(store.has(scan));
    store.set(scan, mask);
    removed += std::accumulate(mask.begin(), mask.end(), std::size_t{0});
    masks.push_back(std::move(mask));
  }
  for (std::size_t scan = 0; scan < sizes.size(); ++scan) {
    CAPTURE(sizes[scan]);
    CHECK(store.has(scan));
    CHECK(store.point_count(scan) == sizes[scan]);
    CHECK(store.get(scan) == masks[scan]);
  }
  CHECK(store.size() == sizes.size() + 1);
  CHECK_FALSE(store.has(sizes.size()));  // An empty mask is set, a missing one is not.
  CHECK(store.get(sizes.size()).empty());
  CHECK(store.removed_count() == removed);
  CHECK(store.point_count() == std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("A mask set again replaces the first") {
  MaskStore store(1);
  store.set(0, Mask(100, 1));
  store.set(0, {0, 1, 0});
  CHECK(store.get(0) == Mask{0, 1, 0});
  CHECK(store.removed_count() == 1);
}

TEST_CASE("Points that are all kept or all removed take next to nothing") {
  constexpr std::size_t kPoints = 64 * 64 * 3 + 70;  // Two groups of words are full, one is not.
  MaskStore store(1);
  for (const std::uint8_t value : Mask{0, 1}) {
    Mask mask(kPoints, value);
    store.set(0, mask);
    CHECK(store.get(0) == mask);
    CHECK(store.removed_count() == kPoints * value);
    CHECK(store.bytes() < 64 + kPoints / 8 / 16);
    // One point that differs costs one word.
    const std::size_t before = store.bytes();
    for (const std::size_t point : {std::size_t{63}, std::size_t{64 * 64}, kPoints - 71}) {
      mask[point] = 1 - value;
    }
    store.set(0, mask);
    CHECK(store.get(0) == mask);
    CHECK(store.removed_count() == (value == 0 ? 3 : kPoints - 3));
    CHECK(store.bytes() == before + 3 * sizeof(std::uint64_t));
  }
}

TEST_CASE("The semantic id is the lower half of a label word") {
  CHECK(semantic_id(0x00050000U + 252U) == 252);
  CHECK(semantic_id(0xFFFFFFFFU) == 0xFFFF);
  const LabelRule rule;
  CHECK(rule.classify(0xABCD0000U + 252U) == LabelClass::kMoving);
  CHECK(rule.classify(259) == LabelClass::kMoving);
  CHECK(rule.classify(251) == LabelClass::kStatic);
  CHECK(rule.classify(260) == LabelClass::kStatic);
  CHECK(rule.classify(0) == LabelClass::kStatic);
}

TEST_CASE("A label rule is read over another") {
  const LabelRule rule = label_rule_from_json(
      {{"name", "mine"}, {"moving", {7, 5, 7}}, {"ignored", {0, 65535}}}, {}, "rule.json");
  CHECK(rule.name == "mine");
  CHECK(rule.moving == std::vector<std::uint16_t>{5, 7});
  CHECK(rule.classify(65535) == LabelClass::kIgnored);
  CHECK(rule.classify(252) == LabelClass::kStatic);
  const LabelRule again = label_rule_from_json({{"ignored", {1}}}, rule, "rule.json");
  CHECK(again.moving == rule.moving);
  CHECK(again.ignored == std::vector<std::uint16_t>{1});
  const LabelRule back = label_rule_from_json(json::parse(to_json(rule).dump()), {}, "rule.json");
  CHECK(back.moving == rule.moving);
  CHECK(back.ignored == rule.ignored);
}

TEST_CASE("A wrong label rule is an error that says where") {
  const auto read = [](const json& rule) { return label_rule_from_json(rule, {}, "rule.json"); };
  CHECK_THROWS_WITH(read({{"moving", {1, 2}}, {"ignored", {2}}}),
                    Contains("rule.json: label id 2 is both moving and ignored"));
  CHECK_THROWS_AS(read({{"ignored", {252}}}), ConfigurationError);  // Moves by default.
  CHECK_THROWS_WITH(read({{"movin", {1}}}), Contains("Did you mean 'moving'?"));
  CHECK_THROWS_WITH(read({{"moving", 252}}), Contains("rule.json.moving: expected a list"));
  CHECK_THROWS_WITH(read({{"name", 5}}), Contains("rule.json.name"));
  for (const json& id : {json(-1), json(65536), json(1.5), json("car"), json(nullptr),
                         json(std::numeric_limits<std::uint64_t>::max())}) {
    CHECK_THROWS_AS(read({{"moving", json::array({id})}}), ConfigurationError);
  }
}

TEST_CASE("A scan knows where its points stand in its file") {
  Scan scan;
  scan.points.resize(2);
  scan.stored_point_count = 5;
  CHECK(scan.left_out_count() == 3);
  CHECK(scan.stored_position(1) == 1);
  scan.stored_index = {0, 4};
  CHECK(scan.stored_position(1) == 4);
}
