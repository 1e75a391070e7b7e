// SPDX-License-Identifier: MIT
// Data that changes during a run is never scored under the fingerprint of before.
#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>

#include "benchmark/result/sealed_json.h"
#include "benchmark/run/runner.h"
#include "core/files/files.h"
#include "datasets/simulation/scene/simulated.h"
#include "methods/controls/controls.h"
#include "methods/external/external.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// Loads all scans, answers, and meddles before or after that.
class Meddler : public Remover {
 public:
  Meddler(std::function<void()> before, std::function<void()> after)
      : before_(std::move(before)), after_(std::move(after)) {}
  void run(const ScanSource& scans, RemovalSink& sink, const RunContext&) override {
    before_();
    for (std::size_t i = 0; i < scans.size(); ++i) sink.accept(i, Mask(scans.load(i).size(), 0));
    after_();
  }

 private:
  std::function<void()> before_, after_;
};

/// A drive of three scans in a folder, with scan 1 to be replaced by one of equal size.
struct Drive {
  test::TemporaryFolder folder;
  fs::path data = folder.path() / "drive";
  fs::path scan = data / "velodyne/000001.bin";

  Drive() {
    SimulationOptions options;
    options.scene = "town";
    options.sensor = "vlp16";
    options.scans = 3;
    write_simulated(options, data, 2, nullptr);
  }
  void replace_scan() const {
    std::string bytes = read_text(scan);
    std::reverse(bytes.begin(), bytes.begin() + 2);
    write_atomically(scan, bytes);
  }

  /// Runs a method with that name and gives the status and reason of its cell.
  [[nodiscard]] std::pair<std::string, std::string> run(const MethodEntry& method) const {
    MethodRegistry registry;
    registry.add(method);
    Suite suite;
    suite.sequences.push_back({data.string(), {}});
    add_method(suite, method.name, "", registry);
    add_protocol(suite, "erasor", "");
    suite.controls = false;
    suite.threads = 1;
    (void)run_suite(suite, {.out = folder.path() / "run", .overwrite = true});
    const ordered_json cell =
        read_sealed(folder.path() / "run/cells/town" / (method.name + "-default") / "cell.json");
    return {cell["status"], cell["reason"]};
  }
};

MethodEntry meddler(std::function<void()> before, std::function<void()> after) {
  MethodEntry entry = noop_entry();
  entry.name = "meddler";
  entry.make = [before = std::move(before), after = std::move(after)](const Configuration&) {
    return std::make_unique<Meddler>(before, after);
  };
  return entry;
}

void nothing() {}

/// That drive with a method that removes nothing, and a sequence that can always be read.
Suite beside_street(const fs::path& drive) {
  static const MethodRegistry registry = [] {
    MethodRegistry methods;
    methods.add(noop_entry());
    return methods;
  }();
  Suite suite;
  suite.sequences = {{drive.string(), {}}, {"street", {}}};
  suite.sequences[1].options.frames = parse_frame_range("0:0");
  add_method(suite, "noop", "", registry);
  add_protocol(suite, "erasor", "");
  suite.controls = false;
  suite.threads = 1;
  return suite;
}

}  // namespace

TEST_CASE("A scan that is another than when the run began makes its cell bad_data") {
  const Drive drive;
  CHECK(drive.run(meddler(nothing, nothing)).first == "ok");
  // For the method itself: the next run has another fingerprint, so that the cell is run again.
  drive.replace_scan();
  const auto read_by_method = drive.run(meddler([&] { drive.replace_scan(); }, nothing));
  CHECK(read_by_method.first == "bad_data");
  CHECK_THAT(read_by_method.second, Contains("the data changed") && Contains("scan 000001"));
  // Only for the later scoring.
  const auto read_by_scorer = drive.run(meddler(nothing, [&] { drive.replace_scan(); }));
  CHECK(read_by_scorer.first == "bad_data");
  CHECK_THAT(read_by_scorer.second, Contains("the data changed") && Contains("scan 000001"));
  // Left alone it is run again, and well.
  CHECK(drive.run(meddler(nothing, nothing)).first == "ok");
}

TEST_CASE("A stored result stays where its data cannot be read any more") {
  const Drive drive;
  const fs::path out = drive.folder.path() / "run", labels = drive.data / "labels/000001.label";
  const fs::path cell = out / "cells/town/noop-default";
  const Suite suite = beside_street(drive.data);
  REQUIRE(run_suite(suite, {.out = out, .keep_removals = true}).good());
  const std::string stored = read_text(cell / "cell.json"), whole = read_text(labels);
  write_atomically(labels, whole.substr(0, whole.size() - 1));
  for (const bool collect : {true, false}) {
    const RunSummary summary =
        run_suite(suite, {.out = out, .keep_removals = true, .collect = collect});
    REQUIRE(summary.failures.size() == 1);
    CHECK_THAT(summary.failures[0], Contains("000001.label"));
    CHECK_THAT(read_text(out / "results.csv"), Contains("town,noop,default,erasor,bad_data,"));
    CHECK(read_text(cell / "cell.json") == stored);
    CHECK(fs::exists(cell / "removals/000001.label"));
  }
  write_atomically(labels, whole);
  CHECK(run_suite(suite, {.out = out, .keep_removals = true}).reused == 2);
}

TEST_CASE("A sequence that was never read has cells that say so, but not if nothing is to be run") {
  const Drive drive;
  const fs::path out = drive.folder.path() / "run";
  const Suite suite = beside_street(drive.data);
  write_atomically(drive.data / "labels/000001.label", "x");
  const fs::path cell = out / "cells/town/noop-default/cell.json";
  CHECK_FALSE(run_suite(suite, {.out = out, .collect = true}).good());
  CHECK_FALSE(fs::exists(cell));
  CHECK_FALSE(run_suite(suite, {.out = out}).good());
  CHECK(read_sealed(cell)["status"] == "bad_data");
}

TEST_CASE("A program that changes during the run fails its cell") {
  const Drive drive;
  const fs::path manifest = drive.folder.path() / "method/manifest.json";
  fs::create_directories(manifest.parent_path());
  write_atomically(manifest.parent_path() / "run.sh", R"(for scan in velodyne/*.bin; do
  awk -v n=$(($(wc -c <"$scan") / 16)) \
    'BEGIN { for (i = 0; i < n; ++i) printf "%c%c%c%c", 9, 0, 0, 0 }' \
    >"predictions/$(basename "$scan" .bin).label"
done
echo more >>"$1/notes.txt"
)");
  write_atomically(manifest, R"({"name": "self", "sentence": "Changes itself.", "version": "1",
    "online": false, "files": ["notes.txt"],
    "command": ["/bin/sh", "{here}/run.sh", "{here}"]})");
  write_atomically(manifest.parent_path() / "notes.txt", "first\n");
  const auto changed = drive.run(external_entry(manifest));
  CHECK(changed.first == "failed");
  CHECK_THAT(changed.second,
             Contains("files of the program changed during the run") && Contains("manifest.json"));
  // Changed between the start of the run and the method.
  MethodEntry entry = external_entry(manifest);
  write_atomically(manifest.parent_path() / "notes.txt", "second\n");
  CHECK(drive.run(entry).first == "failed");
}
