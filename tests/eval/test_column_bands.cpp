// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "eval/columns/columns.h"
#include "tests/eval/memory_sequence.h"

namespace raymoval::test {

TEST_CASE("bands say where they begin and end", "[columns]") {
  const std::vector<std::string> ranges = {"0-10 m",  "10-20 m", "20-30 m",
                                           "30-40 m", "40-50 m", "50 m and more"};
  const std::vector<std::string> heights = {"below 0.3 m", "0.3-1 m", "1-2 m", "2-4 m",
                                            "4 m and more"};
  for (std::size_t i = 0; i < ranges.size(); ++i) CHECK(range_band_name(i) == ranges[i]);
  for (std::size_t i = 0; i < heights.size(); ++i) CHECK(height_band_name(i) == heights[i]);
}

TEST_CASE("a point on the edge of a range band belongs to the band above", "[columns]") {
  LabelledScan scan;
  for (const float range : {9.5f, 10.0f, 20.0f, 30.0f, 40.0f, 50.0f, 70.0f}) {
    scan.add(range, 0.0f, 0.0f, 40);
  }
  const MemorySequence sequence({scan});
  const RemovalTally tally = tally_removals(sequence.input(), sequence.masks());
  const auto& bands = tally.classes.at(40).by_range;
  const std::vector<std::int64_t> expected = {1, 1, 1, 1, 1, 2};
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(bands[i].points == expected[i]);
  CHECK(tally.classes.at(40).all().points == 7);
}

TEST_CASE("a band of time is a tenth of the scans", "[columns]") {
  // Of four scans, the numbers 0, 1, 2 and 3 are in the tenths 0, 2, 5 and 7.
  std::vector<LabelledScan> scans(4);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t point = 0; point <= i; ++point) scans[i].add(5.0f, 0.0f, 0.0f, 40, point == 1);
  }
  const MemorySequence sequence(scans);
  const RemovalTally tally = tally_removals(sequence.input(), sequence.masks());
  const auto& bands = tally.classes.at(40).by_time;
  const std::vector<std::int64_t> points = {1, 0, 2, 0, 0, 3, 0, 4, 0, 0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    CAPTURE(i);
    CHECK(bands[i].points == points[i]);
    CHECK(bands[i].removed == (points[i] > 1 ? 1 : 0));
  }
  const auto values = column_values(tally);
  const auto third = std::ranges::find(values, "preservation [time 20-30 %]", &ColumnValue::name);
  REQUIRE(third != values.end());
  CHECK(third->share.part == 1);
  CHECK(third->share.whole == 2);
  CHECK(parse_column_name(third->name).axis == "time");
  CHECK(parse_column_name(third->name).band == "20-30 %");
}

TEST_CASE("points nearer than 2.7 m to the sensor's axis are in no column", "[columns]") {
  LabelledScan scan;
  scan.add(2.69f, 0.0f, 9.0f, 40);
  scan.add(2.71f, 0.0f, 9.0f, 40);
  scan.add(1.5f, 2.25f, 0.0f, 40);  // 2.704 m.
  scan.add(1.5f, 2.24f, 0.0f, 40);  // 2.696 m.
  const MemorySequence sequence({scan});
  CHECK(tally_removals(sequence.input(), sequence.masks()).classes.at(40).all().points == 2);
}

TEST_CASE("the name of a column comes apart and together again", "[columns]") {
  struct Expected {
    const char *name, *kind, *group, *axis, *band;
  };
  for (const Expected& expected :
       {Expected{"recall", "recall", "", "", ""},
        Expected{"rejection [range 0-10 m]", "rejection", "", "range", "0-10 m"},
        Expected{"preservation [height below 0.3 m]", "preservation", "", "height", "below 0.3 m"},
        Expected{"rejection [moving-car]", "rejection", "moving-car", "", ""},
        Expected{"rejection [moving-car, range 50 m and more]", "rejection", "moving-car", "range",
                 "50 m and more"},
        Expected{"preservation [a, b, height 1-2 m]", "preservation", "a, b", "height", "1-2 m"},
        Expected{"preservation [a, height b, range 0-10 m]", "preservation", "a, height b", "range",
                 "0-10 m"},
        Expected{"preservation [ranger]", "preservation", "ranger", "", ""}}) {
    CAPTURE(expected.name);
    const ColumnName parts = parse_column_name(expected.name);
    CHECK(parts.kind == expected.kind);
    CHECK(parts.group == expected.group);
    CHECK(parts.axis == expected.axis);
    CHECK(parts.band == expected.band);
    CHECK(parts.text() == expected.name);
  }
}

TEST_CASE("every column of a sequence has one value and says why it has none", "[columns]") {
  LabelledScan scan;
  scan.add(5.0f, 0.0f, 0.0f, 40, true);
  scan.add(15.0f, 0.0f, 0.0f, 252, true);
  const MemorySequence sequence({scan});
  const auto values = column_values(tally_removals(sequence.input(), sequence.masks()));
  // 5 in general and 21 bands of rejection and of preservation; each class has itself, a range
  // band and a height band.
  CHECK(values.size() == 5 + 2 * 21 + 2 * 3);
  std::set<std::string> names;
  for (const ColumnValue& value : values) {
    names.insert(value.name);
    CHECK_FALSE(value.undefined_reason.empty());
  }
  CHECK(names.size() == values.size());
  CHECK(values.front().name == "precision");
  CHECK(values.front().share.part == 1);
  CHECK(values.front().share.whole == 2);
  CHECK(names.contains("rejection [moving-car, range 10-20 m]"));
  CHECK(names.contains("preservation [road, height 1-2 m]"));
  const auto classes = class_columns(tally_removals(sequence.input(), sequence.masks()));
  CHECK(classes.front().description == "Points [moving-car] that are removed.");
  CHECK(classes.back().description == "Points [road, height 1-2 m] that are kept.");
  for (const Column& column : general_columns()) {
    CHECK((column.better == Better::kLower) == (column.name == "residue"));
  }
}

}  // namespace raymoval::test
