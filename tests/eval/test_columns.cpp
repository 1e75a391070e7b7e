// SPDX-License-Identifier: MIT
#include "eval/columns/columns.h"

#include <catch2/catch.hpp>

#include "core/error.h"
#include "tests/eval/memory_sequence.h"
#include "tests/eval/random_sequence.h"

namespace raymoval::test {
namespace {

/// Cars and road in two scans; see the comments for range and height (z + 1.73).
MemorySequence small_drive() {
  LabelledScan first;
  first.add(5.0f, 0.0f, -1.63f, 40);         // Range 5.3, height 0.1.
  first.add(6.0f, 0.0f, -1.63f, 40, true);   // 6.2, 0.1.
  first.add(12.0f, 0.0f, -0.9f, 252, true);  // 12.03, 0.83.
  first.add(12.0f, 0.0f, -0.4f, 252);        // 12.01, 1.33.
  first.add(2.0f, 1.0f, -1.0f, 252);         // Cropped: 2.24 m from the z axis.
  first.add(60.0f, 0.0f, 5.0f, 50, true);    // Out of range.
  first.add(8.0f, 0.0f, 0.0f, 99, true);     // Ignored.
  LabelledScan second;
  second.pose.translation().x() = 100.0;        // Bands are those of the sensor.
  second.add(0.0f, 12.0f, -1.63f, 40);          // 12.1, 0.1.
  second.add(0.0f, 25.0f, 2.5f, 50);            // 25.1, 4.23.
  second.add(0.0f, 6.0f, -8.0f, 327933, true);  // 10.0 exactly: of the upper band; below 0.3.
  return MemorySequence({first, second});
}

EvaluationInput columns_input(const MemorySequence& sequence) {
  EvaluationInput input = sequence.input();
  input.range_m = {0.0, 50.0};
  input.label_rule.ignored = {99};
  return input;
}

const ColumnValue& value_named(const std::vector<ColumnValue>& values, const std::string& name) {
  for (const ColumnValue& value : values) {
    if (value.name == name) return value;
  }
  throw InternalError("no column " + name);
}

void check_share(const std::vector<ColumnValue>& values, const std::string& name, std::int64_t part,
                 std::int64_t whole) {
  CAPTURE(name);
  const Share share = value_named(values, name).share;
  CHECK(share.part == part);
  CHECK(share.whole == whole);
}

bool has_column(const std::vector<ColumnValue>& values, const std::string& name) {
  return std::any_of(values.begin(), values.end(),
                     [&](const ColumnValue& value) { return value.name == name; });
}

}  // namespace

TEST_CASE("columns of a small street", "[columns]") {
  const MemorySequence sequence = small_drive();
  const auto values = column_values(tally_removals(columns_input(sequence), sequence.masks()));
  // Seven points count: static 40 40 40 50, of which one is removed; moving 252 252 253, of which
  // two are.
  check_share(values, "precision", 2, 3);
  check_share(values, "recall", 2, 3);
  check_share(values, "residue", 1, 4);
  check_share(values, "rejection", 2, 3);
  check_share(values, "preservation", 3, 4);
  check_share(values, "rejection [range 0-10 m]", 0, 0);
  check_share(values, "rejection [range 10-20 m]", 2, 3);
  check_share(values, "rejection [height below 0.3 m]", 1, 1);
  check_share(values, "rejection [height 0.3-1 m]", 1, 1);
  check_share(values, "rejection [height 1-2 m]", 0, 1);
  check_share(values, "preservation [range 0-10 m]", 1, 2);
  check_share(values, "preservation [range 20-30 m]", 1, 1);
  check_share(values, "preservation [height 2-4 m]", 0, 0);
  check_share(values, "preservation [height 4 m and more]", 1, 1);
  check_share(values, "rejection [moving-car]", 1, 2);
  check_share(values, "rejection [moving-bicyclist]", 1, 1);
  check_share(values, "rejection [moving-car, height 1-2 m]", 0, 1);
  check_share(values, "preservation [road]", 2, 3);
  check_share(values, "preservation [road, range 10-20 m]", 1, 1);
  check_share(values, "preservation [building]", 1, 1);
  CHECK_FALSE(has_column(values, "rejection [moving-person]"));
  CHECK_FALSE(has_column(values, "rejection [moving-car, range 0-10 m]"));
  CHECK_FALSE(has_column(values, "preservation [other-object]"));
  CHECK_FALSE(value_named(values, "rejection [range 0-10 m]").share.percent().has_value());
  CHECK_FALSE(value_named(values, "rejection [range 0-10 m]").undefined_reason.empty());
  CHECK(value_named(values, "residue").share.percent() == 25.0);
}

TEST_CASE("columns of the controls", "[columns]") {
  const MemorySequence sequence = small_drive();
  const EvaluationInput input = columns_input(sequence);
  const auto of = [&](const MaskStore& masks) {
    return column_values(tally_removals(input, masks));
  };
  const auto oracle = of(sequence.oracle_masks(input.label_rule));
  CHECK(value_named(oracle, "precision").share.percent() == 100.0);
  CHECK(value_named(oracle, "residue").share.percent() == 0.0);
  CHECK(value_named(oracle, "preservation [road]").share.percent() == 100.0);
  const auto noop = of(sequence.constant_masks(false));
  CHECK_FALSE(value_named(noop, "precision").share.percent().has_value());
  CHECK(value_named(noop, "recall").share.percent() == 0.0);
  const auto all = of(sequence.constant_masks(true));
  CHECK(value_named(all, "precision").share.part == 3);
  CHECK(value_named(all, "precision").share.whole == 7);
  CHECK_FALSE(value_named(all, "residue").share.percent().has_value());
  CHECK(value_named(all, "preservation").share.percent() == 0.0);
  CHECK_THROWS_AS(of(MaskStore(2)), MethodError);
  CHECK_THROWS_AS(of(MaskStore(1)), MethodError);
}

TEST_CASE("columns count the points that the erasor protocol evaluates", "[columns]") {
  CloudShape shape;
  shape.points = 2000;
  const MemorySequence sequence = random_sequence(shape);
  EvaluationInput input = columns_input(sequence);
  input.range_m = {2.9, 4.9};
  const ProtocolResult erasor = score_erasor(input, sequence.masks());
  const RemovalTally tally = tally_removals(input, sequence.masks());
  PointTally by_range, by_height;
  for (const auto& [id, of_class] : tally.classes) {
    by_range += of_class.all();
    for (const PointTally& band : of_class.by_height) by_height += band;
  }
  CHECK(by_range.points == erasor.count("evaluated_points"));
  CHECK(by_range.removed == erasor.count("removed_points"));
  CHECK(by_height.points == by_range.points);
  CHECK(by_height.removed == by_range.removed);
  input.threads = 8;
  const auto one = column_values(tally);
  const auto many = column_values(tally_removals(input, sequence.masks()));
  REQUIRE(many.size() == one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(many[i].name == one[i].name);
    CHECK(many[i].share.part == one[i].share.part);
    CHECK(many[i].share.whole == one[i].share.whole);
  }
}

TEST_CASE("classes have the names of the data set", "[columns]") {
  CHECK(LabelRule{}.class_name(252) == "moving-car");
  CHECK(LabelRule{}.class_name(9) == "label-9");
  CHECK(LabelRule{"dynamicmap", {1}, {}, {}}.class_name(1) == "label-1");
  // A described column for each, and all names differ.
  for (const Column& column : general_columns()) {
    CHECK_FALSE(column.description.empty());
    CHECK_FALSE(column.undefined_reason.empty());
    CHECK(std::count_if(general_columns().begin(), general_columns().end(),
                        [&](const Column& other) { return other.name == column.name; }) == 1);
  }
}

}  // namespace raymoval::test
