// SPDX-License-Identifier: MIT
#include "benchmark/suite/cell_selection.h"

#include <catch2/catch.hpp>

#include "core/error.h"

using namespace raymoval;

namespace {

const std::vector<std::string> kCells = {"town/noop:default", "town/raymoval:online",
                                         "street/noop:default", "street/raymoval:online",
                                         "street/raymoval:offline"};

std::vector<bool> selected(const std::vector<std::string>& only) {
  return select_cells(only, kCells);
}

}  // namespace

TEST_CASE("A pattern fits a cell, its sequence or its method") {
  CHECK(selected({}) == std::vector<bool>{true, true, true, true, true});
  CHECK(selected({"street"}) == std::vector<bool>{false, false, true, true, true});
  CHECK(selected({"raymoval:o*line"}) == std::vector<bool>{false, true, false, true, true});
  CHECK(selected({"street/*:off*"}) == std::vector<bool>{false, false, false, false, true});
  CHECK(selected({"town/noop:default", "street/noop:default"}) ==
        std::vector<bool>{true, false, true, false, false});
  CHECK_THROWS_AS(selected({"street", "road"}), UsageError);
  CHECK_THROWS_AS(selected({"tow"}), UsageError);
}
