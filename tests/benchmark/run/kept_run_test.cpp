// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/kept_run.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/result/run_record_json.h"
#include "benchmark/run/runner.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "datasets/layouts.h"
#include "tests/benchmark/small_suite.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using raymoval::test::write_drive;
namespace fs = std::filesystem;

namespace {

/// A run of noop, which keeps all points, on sequences `drive` and ROOT:05.
struct TwoSequences {
  test::TemporaryFolder folder;
  fs::path root = folder.path() / "data", run = folder.path() / "run";

  TwoSequences() {
    write_drive(folder, "data/drive");
    write_drive(folder, "data/sequences/05");
    // Other data than that of `drive`.
    (void)folder.write("data/sequences/05/velodyne/000000.bin",
                       test::floats({5, 0, 0, 0, 5, 11, 0, 0}));
    Suite suite = test::noop_on(root / "drive");
    suite.sequences.push_back({root.string() + ":05", suite.sequences[0].options});
    suite.sequences[0].options.name = "drive";
    suite.sequences[1].options.name = "five";
    (void)run_suite(suite, {.out = run, .keep_removals = true});
  }
  [[nodiscard]] std::size_t scans_of(const std::string& sequence, const fs::path& data = "") const {
    return KeptRun(run.string(), data.string()).open(sequence, {}).scans->size();
  }
  /// Changes what results.json says.
  template <class Change>
  void change_results(Change change) const {
    ResultsRecord results = read_results(run / "results.json");
    change(results);
    write_results(run / "results.json", results);
  }
};

}  // namespace

TEST_CASE("A kept run knows its cells, those that were not run included") {
  const TwoSequences two;
  two.change_results([](ResultsRecord& results) {
    results.cells[0].fail(CellStatus::kTimeout, "took too long");
    results.cells.pop_back();
  });
  const KeptRun run(two.run.string(), "");
  REQUIRE(run.cells().size() == 2);
  const KeptCell& failed = run.cell("drive", "noop:default");
  CHECK(failed.sequence == "drive");
  CHECK(failed.name == "noop:default");
  CHECK(failed.control);
  CHECK(failed.status == "timeout");
  CHECK(failed.reason == "took too long");
  CHECK_FALSE(failed.has_result());
  CHECK_FALSE(failed.has_removals());  // There are some, but not of a result.
  CHECK(fs::exists(failed.removals / "000000.label"));
  const KeptCell& missing = run.cell("five", "noop:default");
  CHECK(missing.cell == nullptr);
  CHECK_FALSE(missing.control);
  CHECK(missing.status == "not run");
  CHECK(missing.reason.empty());
  CHECK_FALSE(missing.has_result());
  CHECK(run.cells_of("five") == std::vector<const KeptCell*>{&missing});
  CHECK(run.cells_of("nowhere").empty());
  CHECK_THROWS_WITH(
      run.cell("drive", "nop:default"),
      Contains("--method nop:default: this run has no such method.") && Contains("'noop:default'"));
  CHECK_THROWS_WITH(
      run.cell("fives", "noop:default"),
      Contains("--sequence fives: this run has no such sequence.") && Contains("'five'"));
  const Sequence sequence = run.open("drive", {});
  CHECK_THROWS_WITH(run.masks(failed, sequence),
                    Catch::Equals("drive / noop:default: timeout, took too long."));
  CHECK_THROWS_WITH(run.masks(missing, sequence), Catch::Equals("five / noop:default: not run."));
  CHECK(run.record().cells.size() == 1);
  CHECK(run.results().sequences == std::vector<std::string>{"drive", "five"});
}

TEST_CASE("Removals are given only if they were kept and are those of the result") {
  const TwoSequences two;
  {
    const KeptRun run(two.run.string(), "");
    const KeptCell& cell = run.cell("drive", "noop:default");
    CHECK(run.masks(cell, run.open("drive", {})).get(0) == Mask{0, 0});
    fs::rename(cell.removals, two.run / "aside");
    CHECK_THROWS_WITH(run.masks(cell, run.open("drive", {})),
                      Contains("drive / noop:default: its removals were not stored") &&
                          Contains("--keep-removals"));
    fs::rename(two.run / "aside", cell.removals);
  }
  two.change_results([](ResultsRecord& results) { results.cells[0].masks.reset(); });
  const KeptRun run(two.run.string(), "");
  CHECK_THROWS_WITH(run.masks(run.cell("drive", "noop:default"), run.open("drive", {})),
                    Contains("removals: is not what was scored"));
}

TEST_CASE("A sequence that was moved is looked for below --data, by the run's place and its name") {
  const TwoSequences two;
  CHECK(two.scans_of("drive") == 1);
  CHECK(two.scans_of("five") == 1);
  const fs::path moved = two.folder.path() / "moved";
  fs::rename(two.root, moved);
  CHECK_THROWS_WITH(two.scans_of("drive"), Contains("sequence 'drive' cannot be opened again") &&
                                               Contains("name its folder with --data"));
  CHECK(two.scans_of("drive", moved) == 1);
  CHECK(two.scans_of("five", moved) == 1);
  CHECK(two.scans_of("drive", moved / "drive") == 1);
  CHECK(two.scans_of("five", moved.string() + ":05") == 1);
  // By the name in the run, where the folder has that.
  fs::rename(moved / "sequences/05", moved / "five");
  fs::remove(moved / "sequences");
  CHECK(two.scans_of("five", moved) == 1);
  // The message names the other data there, and not the other failed attempts.
  fs::rename(moved / "five", two.folder.path() / "aside");
  CHECK_THROWS_WITH(two.scans_of("five", moved),
                    Contains("sequence 'five' cannot be opened again"));
  (void)two.folder.write("moved/drive/velodyne/000000.bin", test::floats({6, 0, 0, 0, 5, 9, 0, 0}));
  try {
    (void)two.scans_of("drive", moved);
    FAIL("other data was opened");
  } catch (const DataError& error) {
    CHECK_THAT(error.what(), Contains("its fingerprint is another"));
    CHECK_THAT(error.what(), !Contains("If it was moved"));  // --data says where it is.
  }
  CHECK_THROWS_AS(KeptRun(two.run.string(), (moved / "none").string()), UsageError);
  CHECK_THROWS_WITH(KeptRun(two.run.string(), (moved / "none").string() + ":05"),
                    Contains("none:05: no such folder"));
}

TEST_CASE("Without run.json only --data says where a sequence is") {
  const TwoSequences two;
  fs::remove(two.run / "run.json");
  CHECK_THROWS_WITH(two.scans_of("drive"),
                    Contains("run.json has no folder for sequence 'drive'") &&
                        Contains("Name its folder with --data."));
  CHECK(two.scans_of("drive", two.root) == 1);
  // With the frames of the run, of which there are more now.
  for (const char* part : {"velodyne/00000%.bin", "labels/00000%.label"}) {
    std::string from = part, to = part;
    from.replace(from.find('%'), 1, "0");
    to.replace(to.find('%'), 1, "1");
    fs::copy(two.root / "drive" / from, two.root / "drive" / to);
  }
  (void)two.folder.write("data/drive/poses.txt", test::kIdentityRow + test::kIdentityRow);
  const Sequence again = KeptRun(two.run.string(), two.root.string()).open("drive", {});
  CHECK(again.scans->size() == 1);
  CHECK(again.name == "drive");
  CHECK(KeptRun(two.run.string(), two.root.string() + ":05").open("five", {}).name == "five");
  CHECK_THROWS_AS(two.scans_of("nowhere", two.root), DataError);
  // Nothing is known of a sequence that the run does not have.
  CHECK_THROWS_WITH(two.scans_of("nowhere"), Contains("'nowhere'"));
}

TEST_CASE("A scene that a run.json names is not made unless somebody asks for that") {
  const TwoSequences two;
  RunRecord run = read_run_record(two.run / "run.json");
  run.sequences.at(0).place->path = "town:scans=2,seed=20261122";
  write_run_record(two.run / "run.json", run);
  CHECK_THROWS_WITH(KeptRun(two.run.string(), "").open("drive", {}),
                    Contains("is a scene that is not in the cache"));
}

TEST_CASE("A stop and a disk that does not answer are no reason to look elsewhere") {
  const TwoSequences two;
  // In the sequence's place there is a layout whose opening is stopped.
  Layout layout;
  layout.name = "stopped";
  layout.expected = "a folder that is called stopped";
  layout.recognise = [](Layout::Path path) { return fs::path(path).filename() == "stopped"; };
  layout.open = [](Layout::Path, const SequenceOptions&, const OpenContext&) -> Sequence {
    throw Cancelled();
  };
  static const bool known = (register_layout(layout), true);
  REQUIRE(known);
  fs::create_directory(two.folder.path() / "stopped");
  CHECK_THROWS_AS(two.scans_of("drive", two.folder.path() / "stopped"), Cancelled);
  fs::remove(two.root / "drive/poses.txt");
  fs::create_symlink("poses.txt", two.root / "drive/poses.txt");
  CHECK_THROWS_AS(two.scans_of("drive"), UnreadableError);
}
