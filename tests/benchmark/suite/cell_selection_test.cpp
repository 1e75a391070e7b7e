// SPDX-License-Identifier: MIT
#include "benchmark/suite/cell_selection.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "core/error.h"

using namespace raymoval;

namespace {

const std::vector<std::string> kCells = {"town/noop:default", "town/raymoval:online",
                                         "street/noop:default", "street/raymoval:online",
                                         "street/raymoval:offline"};

std::vector<bool> selected(const std::vector<std::string>& only, const std::string& shard = "1/1") {
  CellSelection selection;
  selection.only = only;
  parse_shard(shard, selection);
  return select_cells(selection, kCells);
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

TEST_CASE("Shards cut what the patterns leave into equal parts of neighbours") {
  // Five cells in two parts: three and two.
  CHECK(selected({}, "1/2") == std::vector<bool>{true, true, true, false, false});
  CHECK(selected({}, "2/2") == std::vector<bool>{false, false, false, true, true});
  CHECK(selected({"street"}, "3/3") == std::vector<bool>{false, false, false, false, true});
}

TEST_CASE("Every cell is in exactly one shard, and shards differ by one cell at most") {
  const std::vector<std::string> cells(17, "s/m");
  for (std::size_t shards = 1; shards <= 20; ++shards) {
    std::vector<int> owners(cells.size(), 0);
    for (std::size_t shard = 1; shard <= shards; ++shard) {
      CellSelection selection;
      selection.shard = shard;
      selection.shards = shards;
      const std::vector<bool> mine = select_cells(selection, cells);
      const auto count = static_cast<std::size_t>(std::count(mine.begin(), mine.end(), true));
      CHECK(count >= cells.size() / shards);
      CHECK(count <= cells.size() / shards + 1);
      for (std::size_t i = 0; i < cells.size(); ++i) owners[i] += mine[i] ? 1 : 0;
    }
    CHECK(owners == std::vector<int>(cells.size(), 1));
  }
}

TEST_CASE("A shard is I/N") {
  CellSelection selection;
  for (const char* bad : {"", "1", "0/2", "3/2", "1/0", "a/2", "1/2/3", "-1/2", "1/"}) {
    CHECK_THROWS_AS(parse_shard(bad, selection), UsageError);
  }
}
