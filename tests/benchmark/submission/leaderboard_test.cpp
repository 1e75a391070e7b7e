// SPDX-License-Identifier: MIT
#include "benchmark/submission/leaderboard.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace raymoval;

namespace {

/// A submission that holds, with these rates by the protocol `mos`.
Verification held_submission(const std::string& method, std::vector<Rate> rates) {
  Verification verified;
  Cell& cell = verified.submitted.cell;
  cell.sequence = "street";
  cell.name = method;
  cell.data.emplace();
  cell.data->fingerprint = "0123";
  cell.scores.push_back({{"mos", "mos", "1"}});
  cell.scores[0].rates = rates;
  verified.scores.protocols.push_back({"mos", {}, std::move(rates), {}});
  return verified;
}

std::vector<std::string> columns_of(const std::vector<Verification>& verified) {
  const std::vector<TextTable> tables = leaderboard(verified);
  REQUIRE(tables.size() == 1);
  return tables[0].groups.at(0).columns;
}

bool has_column(const std::vector<std::string>& columns, const std::string& name) {
  return std::find(columns.begin(), columns.end(), name) != columns.end();
}

}  // namespace

TEST_CASE("A leaderboard has the rates that any of its methods has, whichever comes first") {
  const Verification idle = held_submission(
      "idle", {{"precision", {}, "no point was removed"}, {"recall", 0.0}, {"IoU", 0.0}});
  const Verification busy =
      held_submission("busy", {{"precision", 80.0}, {"recall", 50.0}, {"IoU", 44.0}});
  const std::vector<std::string> columns = columns_of({idle, busy});
  CHECK(has_column(columns, "precision"));
  CHECK(columns == columns_of({busy, idle}));
  // What no method has is no column.
  CHECK_FALSE(has_column(columns_of({idle}), "precision"));
}
