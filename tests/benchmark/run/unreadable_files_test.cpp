// SPDX-License-Identifier: MIT
// An unreadable file is never taken for absent or damaged, which would replace it: the system's
// error is reported.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/result/removals/removal_files.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/folder/folder_content.h"
#include "benchmark/run/folder/run_folder.h"
#include "core/files/file_kind.h"
#include "tests/benchmark/small_world.h"
#include "tests/datasets/unreadable.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using raymoval::test::make_unreadable;
using raymoval::test::NothingOpens;
namespace fs = std::filesystem;

namespace {

const CellName kTown{"town", "comb"};

/// A folder with the cell `kTown` and its removals.
struct Stored {
  test::TemporaryFolder folder;
  CellStore store{folder.path()};
  CellIdentity identity;
  Cell cell;

  Stored() {
    identity.method = {"comb", "default", "1", false, false, {}};
    identity.data = DataRecord{"town", "files"};
    cell = {kTown.sequence, kTown.name, cell_key(identity)};
    cell.method = identity.method;
    cell.data = identity.data;
    MaskStore masks(2);
    masks.set(0, {0, 1, 1});
    masks.set(1, {1});
    cell.masks = MaskRecord{mask_digest(masks), 3};
    store.prepare(kTown);
    const fs::path removals = store.new_removals(kTown);
    write_removals(removals, test::TwoScans(), masks, [] {});
    store.keep(cell, removals);
  }
};

}  // namespace

TEST_CASE("A cell that cannot be read is no missing one, and none to run again", "[no-files]") {
  const Stored stored;
  const test::TwoScans scans;
  REQUIRE(stored.store.find(kTown, stored.identity, &scans).state == StoredCell::State::kFresh);
  {
    const NothingOpens full;
    CHECK_THROWS_AS(stored.store.find(kTown, stored.identity, nullptr), UnreadableError);
  }
  make_unreadable(stored.store.folder(kTown) / "removals/000007.label");
  CHECK_THROWS_AS(stored.store.find(kTown, stored.identity, &scans), UnreadableError);
  CHECK(stored.store.find(kTown, stored.identity, nullptr).state == StoredCell::State::kFresh);
  make_unreadable(stored.store.folder(kTown) / "cell.json");
  CHECK_THROWS_AS(stored.store.has_result(kTown), UnreadableError);
}

TEST_CASE("Removals that cannot be put in their place are told, and there is no cell without") {
  const Stored stored;
  // No folder can become a part of itself.
  CHECK_THROWS_WITH(stored.store.keep(stored.cell, stored.folder.path()),
                    Contains("removals: cannot be made ("));
  CHECK_FALSE(fs::exists(stored.store.folder(kTown) / "cell.json"));
}

TEST_CASE("The record and the cells of a folder that cannot be read are no damaged ones",
          "[no-files]") {
  const Stored stored;
  RunRecord run{"suite"};
  run.sequences = {{*stored.cell.data, std::nullopt}};
  run.methods = {{"comb", "comb:default", "1", {}, {}}};
  run.cells = run.all_cells();
  write_run_record(stored.folder.path() / "run.json", run);
  REQUIRE(present_record(stored.folder.path()));
  {
    const NothingOpens full;
    CHECK_THROWS_AS(present_record(stored.folder.path()), UnreadableError);
    // It has no marker yet; its run.json would say that it is a run's folder.
    CHECK_THROWS_AS(prepare_run_folder(stored.folder.path()), UnreadableError);
  }
  REQUIRE(read_earlier_cells(stored.store, run, RunRecord{}).kept.size() == 1);
  make_unreadable(stored.store.folder(kTown) / "cell.json");
  CHECK_THROWS_AS(read_earlier_cells(stored.store, run, RunRecord{}), UnreadableError);
}
