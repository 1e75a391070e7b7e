// SPDX-License-Identifier: MIT
#include "benchmark/clean/rows/map_rows.h"

#include <catch2/catch.hpp>

#include "tests/benchmark/clean/recorded_scans.h"

using namespace raymoval;
using namespace raymoval::test;

TEST_CASE("The confidence stands behind all other fields, which stay") {
  const ScanRows rows{records_of(driver_layout(), {{1, 2, 3, 0.5, 7, 9}, {4, 5, 6, 0.5, 8, 9}}),
                      {{1, 2, 3}, {4, 5, 6}}};
  const RecordLayout layout = layout_with_confidence(driver_layout());
  const ScanRows more = rows_with_confidence(rows, layout, {static_cast<char>(250), 25});
  CHECK(more.rows.size() == 2);
  CHECK(value_of(more.rows, 0, "x") == 1.0);
  CHECK(value_of(more.rows, 1, "ring") == 8.0);
  CHECK(value_of(more.rows, 0, "confidence") == 1.0);
  CHECK(value_of(more.rows, 1, "confidence") == Approx(0.1));
  CHECK(more.world[1] == Eigen::Vector3d(4, 5, 6));
}

TEST_CASE("A field of the scans that is called confidence stays as it is") {
  RecordLayout layout = driver_layout();
  layout.add("confidence", 'F', 4);
  const RecordLayout more = layout_with_confidence(layout);
  CHECK(more.fields.back().name == "raymoval_confidence");
  CHECK(more.fields.size() == layout.fields.size() + 1);
}
