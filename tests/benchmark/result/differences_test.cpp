// SPDX-License-Identifier: MIT
// What differs between cells, in words.
#include "benchmark/result/checks/differences.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/result/cell_json.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/result/run_record_json.h"
#include "tests/benchmark/result/full_cell.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using nlohmann::ordered_json;
using test::full_cell;

TEST_CASE("What differs between two cells is told in words", "[result]") {
  const ordered_json json = full_cell();
  const std::string file = "cell.json";
  const Cell cell = read_as<Cell>(json, file);
  const CellIdentity same{cell.method, *cell.data, protocols_of(cell)};
  const auto difference_with = [&](auto change) {
    CellIdentity wanted = same;
    change(wanted);
    CHECK(cell_key(wanted) != cell_key(same));
    return identity_difference(cell, wanted);
  };
  CHECK(difference_with([](CellIdentity& to) { to.method.parameters[0].second = 1.0; }) ==
        "parameter size was 0.5, is 1.0");
  CHECK(difference_with([](CellIdentity& to) { to.method.parameters.clear(); }) ==
        "parameter size was removed");
  CHECK(difference_with([](CellIdentity& to) { to.method.version = "2"; }) ==
        "method version was \"1\", is \"2\"");
  CHECK(difference_with([](CellIdentity& to) { to.protocols[0].options[0].second = 1.5; }) ==
        "protocol erasor options lift was 0.0, is 1.5");
  CHECK(difference_with([](CellIdentity& to) { to.protocols.clear(); }) ==
        "protocol erasor is no longer requested");
  CHECK(difference_with([](CellIdentity& to) { to.protocols[0].name = "other"; }) ==
        "protocol other is new");
  CHECK(difference_with([](CellIdentity& to) { to.data.range_m = {}; }) ==
        "data range_m max was 50.0, is null");
  CHECK(difference_with([](CellIdentity& to) { to.data.label_rule->moving = {1}; }) ==
        "data label_rule moving was [252], is [1]");
  CHECK(identity_difference(cell, same) == "it was made with other settings");
  Cell older = cell;
  older.columns.reset();
  CHECK(identity_difference(older, same) == "columns is new");
}
