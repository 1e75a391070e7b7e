// SPDX-License-Identifier: MIT
#include "benchmark/submission/leaderboard.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "eval/protocol_registry.h"

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

namespace {

/// The same submission, scored by another protocol as well: before or after the one that it has.
Verification scored_also(Verification verified, const ProtocolRecord& protocol, bool before) {
  std::vector<Score>& scores = verified.submitted.cell.scores;
  std::vector<ProtocolResult>& results = verified.scores.protocols;
  const ProtocolResult result{protocol.protocol, {}, {{"precision", 10.0}, {"IoU", 10.0}}, {}};
  scores.insert(before ? scores.begin() : scores.end(), Score{protocol});
  results.insert(before ? results.begin() : results.end(), result);
  return verified;
}

/// Title and number of rows of each table.
std::vector<std::pair<std::string, std::size_t>> sizes_of(
    const std::vector<Verification>& verified) {
  std::vector<std::pair<std::string, std::size_t>> sizes;
  for (const TextTable& table : leaderboard(verified)) {
    sizes.emplace_back(table.title, table.rows.size());
  }
  return sizes;
}

}  // namespace

TEST_CASE("A leaderboard ranks together what one protocol scored, whatever else did") {
  using Sizes = std::vector<std::pair<std::string, std::size_t>>;
  const std::vector<Rate> rates = {{"precision", 80.0}, {"recall", 50.0}, {"IoU", 44.0}};
  const Verification only = held_submission("only", rates);
  const ProtocolRecord erasor{"erasor", "erasor", "1"};
  const Sizes expected = {{"street by protocol mos", 3}, {"street by protocol erasor", 2}};
  const Verification first = scored_also(held_submission("first", rates), erasor, true);
  const Verification last = scored_also(held_submission("last", rates), erasor, false);
  CHECK(sizes_of({only, first, last}) == expected);
  CHECK(sizes_of({last, first, only}) == expected);
  // Each row has the rates of its own protocol.
  const std::vector<TextTable> tables = leaderboard({only, first, last});
  REQUIRE(tables.size() == 2);
  for (const TableRow& row : tables[0].rows) CHECK(row.cells.at(3).text == "80.000");

  // The name that a suite gives a protocol does not matter; version, options and data do.
  Verification other = held_submission("other", rates);
  other.submitted.cell.scores[0].protocol.name = "by scans";
  CHECK(sizes_of({only, other}) == Sizes{{"street by protocol mos", 2}});
  CHECK(sizes_of({scored_also(only, other.submitted.cell.scores[0].protocol, false)}) ==
        Sizes{{"street by protocol mos", 1}});
  other.submitted.cell.data->fingerprint = "4567";
  CHECK(sizes_of({only, other}).size() == 2);
  Verification older = only;
  older.submitted.cell.scores[0].protocol.version = "0";
  CHECK(sizes_of({only, older}).size() == 2);
}

TEST_CASE("Tables of a protocol with other options say so in their titles") {
  const Verification usual = held_submission("usual", {{"IoU", 44.0}});
  Verification set = usual;
  Configuration& options = set.submitted.cell.scores[0].protocol.options;
  options = protocol_defaults("mos");
  CHECK(leaderboard({set}).at(0).title == "street by protocol mos");
  options.emplace_back("made_up", std::int64_t{3});
  CHECK(leaderboard({usual, set}).at(1).title == "street by protocol mos, made_up = 3");
}
