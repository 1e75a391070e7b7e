// SPDX-License-Identifier: MIT
#include "benchmark/result/removals/edits.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"
#include "core/files/files.h"
#include "tests/benchmark/clean/recorded_scans.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;
using Catch::Matchers::Contains;

namespace {

/// Two scans from (10, 0, 0) and (20, 0, 0), each of four points on the x axis at 1 m, 1.1 m, 5 m
/// and 6 m. In the world, the points are at 11, 11.1, 15 and 16 m, and at 21, 21.1, 25 and 26 m.
std::shared_ptr<RecordedScans> two_line_scans() {
  const auto rows = records_of(
      driver_layout(),
      {{1.0, 0, 0, 0.5, 0}, {1.1, 0, 0, 0.5, 1}, {5.0, 0, 0, 0.5, 2}, {6.0, 0, 0, 0.5, 3}});
  return std::make_shared<RecordedScans>(std::vector{rows, rows},
                                         std::vector{Pose(Eigen::Translation3d(10.0, 0.0, 0.0)),
                                                     Pose(Eigen::Translation3d(20.0, 0.0, 0.0))});
}

/// The edits of two scans without corrections: the first two points of each are removed.
Edits reviewed_edits(const ScanSource& scans) {
  Edits edits;
  edits.sequence = "line";
  edits.method = "method";
  for (std::size_t i = 0; i < scans.size(); ++i) {
    edits.scans.push_back(reviewed_scan(scans.load(i), {1, 1, 0, 0}));
  }
  return edits;
}

nlohmann::ordered_json edits_file(const Edits& edits) {
  nlohmann::ordered_json content = to_json(edits);
  content["keep"] = nlohmann::ordered_json::array();
  content["remove"] = nlohmann::ordered_json::array();
  return content;
}

EditedMasks applied(const Edits& edits, const ScanSource& scans, bool force = false) {
  return apply_edits(edits, scans, "edits.json", force, [] {});
}

const std::string kExportAgain = "Export the file with";

}  // namespace

TEST_CASE("Runs of removed points are first points and counts") {
  const auto scans = two_line_scans();
  CHECK(reviewed_scan(scans->load(0), {1, 1, 0, 1}).runs == std::vector<std::uint64_t>{0, 2, 3, 1});
  CHECK(reviewed_scan(scans->load(0), {0, 0, 0, 0}).runs.empty());
  // 2 is `kLeftOutMask`: in no output.
  CHECK(reviewed_scan(scans->load(0), {2, 1, 2, 1}).runs == std::vector<std::uint64_t>{1, 1, 3, 1});
}

TEST_CASE("Without corrections, edits give the masks that were reviewed") {
  const auto scans = two_line_scans();
  const EditedMasks edited = applied(reviewed_edits(*scans), *scans);
  CHECK(edited.masks.get(0) == Mask{1, 1, 0, 0});
  CHECK(edited.masks.get(1) == Mask{1, 1, 0, 0});
  CHECK(edited.kept + edited.removed == 0);
}

TEST_CASE("A correction keeps the removed points of a scan, and removes kept points of all scans") {
  const auto scans = two_line_scans();
  Edits edits = reviewed_edits(*scans);
  // 11 m and 11.1 m are in the voxel from 11.0 m to 11.2 m, number 55.
  edits.keep.insert({0, 55, 0, 0});
  // The same cell in another scan, in which no point is in it.
  edits.keep.insert({1, 55, 0, 0});
  // 25 m is in voxel 125. A removed point (21 m, voxel 105) is not changed by `remove`.
  edits.remove.insert({-1, 125, 0, 0});
  edits.remove.insert({-1, 105, 0, 0});
  const EditedMasks edited = applied(edits, *scans);
  CHECK(edited.masks.get(0) == Mask{0, 0, 0, 0});
  CHECK(edited.masks.get(1) == Mask{1, 1, 1, 0});
  CHECK(edited.kept == 2);
  CHECK(edited.removed == 1);
}

TEST_CASE("Cells may be larger than voxels, and below zero") {
  const MapSteps below = map_steps({-0.01, 0.0, 0.41});
  CHECK(below == MapSteps{-1, 0, 32});
  CHECK(map_cell(below, 16) == MapSteps{-1, 0, 2});
  CHECK(map_cell(below, 32) == MapSteps{-1, 0, 1});
  CHECK(map_cell({-32, -33, 31}, 32) == MapSteps{-1, -2, 0});
}

TEST_CASE("The frame of the cells is the one that has up as z") {
  const auto scans = two_line_scans();
  Edits edits = reviewed_edits(*scans);
  edits.R_upright_world << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x becomes y.
  edits.keep.insert({0, 0, 55, 0});
  CHECK(applied(edits, *scans).masks.get(0) == Mask{0, 0, 0, 0});
}

TEST_CASE("Edits of other data are refused") {
  const auto scans = two_line_scans();
  Edits edits = reviewed_edits(*scans);
  edits.scans[1].digest = "0123456789abcdef";
  CHECK_THROWS_WITH(applied(edits, *scans),
                    Contains("1 of 2 scans have another pose or other points (first: scan1)") &&
                        Contains("--force"));
  CHECK(applied(edits, *scans, true).changed_scans == 1);
  edits.scans[1].points = 5;
  CHECK_THROWS_WITH(applied(edits, *scans, true), Contains("first: scan1") && !Contains("--force"));
  edits.scans.pop_back();
  CHECK_THROWS_WITH(applied(edits, *scans), Contains("the edits are for 1 scan of line, but there "
                                                     "are 2"));
}

TEST_CASE("A file of edits is read as it was written") {
  const TemporaryFolder folder;
  const auto scans = two_line_scans();
  nlohmann::ordered_json content = edits_file(reviewed_edits(*scans));
  content["keep"].push_back({0, 55, 0, 0});
  content["remove"].push_back({125, 0, 0});
  content["removed_cell"] = 16;
  write_atomically(folder.path() / "edits.json", content.dump());
  const Edits edits = read_edits(folder.path() / "edits.json");
  CHECK(edits.sequence == "line");
  CHECK(applied(edits, *scans).masks.get(0) == Mask{0, 0, 0, 0});
  CHECK(applied(edits, *scans).masks.get(1) == Mask{1, 1, 1, 0});
}

TEST_CASE("Damaged edits are named") {
  const TemporaryFolder folder;
  const auto scans = two_line_scans();
  const auto message = [&](const std::function<void(nlohmann::ordered_json&)>& damage) {
    nlohmann::ordered_json content = edits_file(reviewed_edits(*scans));
    damage(content);
    write_atomically(folder.path() / "e.json", content.dump());
    try {
      applied(read_edits(folder.path() / "e.json"), *scans);
    } catch (const ConfigurationError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(message([](auto& json) { json.erase("raymoval_edits"); }), Contains("is not a file of "
                                                                                 "edits"));
  CHECK_THAT(message([](auto& json) { json["raymoval_edits"] = 2; }), Contains("has version 2"));
  CHECK_THAT(message([](auto& json) { json["scans"][0].erase("digest"); }), Contains(kExportAgain));
  CHECK_THAT(message([](auto& json) { json["keep"] = {{1, 2, 3}}; }), Contains(kExportAgain));
  CHECK_THAT(message([](auto& json) { json["keep"] = {{0, 1e30, 3, 4}}; }), Contains(kExportAgain));
  CHECK_THAT(message([](auto& json) { json["turn"] = {1, 2}; }), Contains(kExportAgain));
  CHECK_THAT(message([](auto& json) { json["removed_cell"] = 0; }),
             Contains("no whole number from 1"));
  CHECK_THAT(message([](auto& json) {
               json["scans"][0]["removed"] = {3, 2};
             }),
             Contains("run of 2 "
                      "points"));
  CHECK_THAT(message([](auto& json) {
               json["scans"][0]["removed"] = {2, 1, 1, 1};
             }),
             Contains("does not follow"));
  CHECK_THAT(message([](auto& json) { json["scans"][0]["points"] = 1e18; }),
             Contains(kExportAgain));
}

TEST_CASE("Any mask survives the way through a file") {
  std::mt19937 random(1);
  const auto scans = two_line_scans();
  for (int round = 0; round < 50; ++round) {
    Edits edits = reviewed_edits(*scans);
    Mask mask(4);
    for (std::uint8_t& removed : mask) removed = random() % 2;
    edits.scans[0] = reviewed_scan(scans->load(0), mask);
    CHECK(applied(edits, *scans).masks.get(0) == mask);
  }
}

TEST_CASE("Corrected masks are labels") {
  MaskStore masks(1);
  masks.set(0, {1, 0});
  CHECK(labels_of_masks(std::move(masks))->labels({}) == std::vector<std::uint32_t>{251, 9});
}
