// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/map_picture.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <optional>

#include "benchmark/result/run_record_json.h"
#include "benchmark/run/runner.h"
#include "core/error.h"
#include "core/files/files.h"
#include "methods/controls/controls.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

namespace fs = std::filesystem;

/// Fails always.
class Broken : public Remover {
 public:
  void run(const ScanSource&, RemovalSink&, const RunContext&) override {
    throw MethodError("it has no idea");
  }
};

MethodRegistry registry_with_broken() {
  MethodRegistry methods;
  methods.add(noop_entry());
  methods.add(remove_all_entry());
  methods.add(oracle_entry());
  MethodEntry broken = noop_entry();
  broken.name = "broken";
  broken.make = [](const Configuration&) { return std::make_unique<Broken>(); };
  methods.add(std::move(broken));
  return methods;
}

/// The two points, and a run on them with all controls and a method that fails.
struct TwoPointRun {
  test::TemporaryFolder folder;
  fs::path data = folder.path() / "two";
  fs::path run = folder.path() / "run";

  explicit TwoPointRun(bool keep_removals = true) {
    test::write_drive(folder, "two");  // A static point at (5, 0, 0), a moving one at (5, 10, 0).
    static const MethodRegistry methods = registry_with_broken();
    Suite suite;
    suite.sequences.push_back({data.string(), {}});
    add_method(suite, "broken", "", methods);
    add_protocol(suite, "erasor", "");
    add_controls(suite, methods);
    RunOptions options;
    options.out = run;
    options.keep_removals = keep_removals;
    (void)run_suite(suite, options);
  }
  [[nodiscard]] KeptRun kept(const std::string& data_now = "") const {
    return KeptRun(run.string(), data_now);
  }
};

/// Where scenes are made while it lives.
class EmptyCache {
 public:
  explicit EmptyCache(const fs::path& folder) {
    if (const char* known = std::getenv("RAYMOVAL_CACHE")) before_ = known;
    ::setenv("RAYMOVAL_CACHE", folder.c_str(), 1);
  }
  ~EmptyCache() {
    if (before_) {
      ::setenv("RAYMOVAL_CACHE", before_->c_str(), 1);
    } else {
      ::unsetenv("RAYMOVAL_CACHE");
    }
  }
  EmptyCache(const EmptyCache&) = delete;
  EmptyCache& operator=(const EmptyCache&) = delete;

 private:
  std::optional<std::string> before_;
};

MapPictureOptions half_metre(const std::string& only) {
  MapPictureOptions options;
  options.only = {only};
  options.panel_pixels = 120;  // 60 m about the sensor: half a metre a pixel.
  return options;
}

// The panel's corner is at (20, 70): margin 20, method names 24, sequence name 26. From above
// (-30, 30) the points are 35 m to the right and 30 and 20 m down: 70 and 60, 70 and 40 pixels.
constexpr int kStaticX = 20 + 70, kStaticY = 70 + 60;
constexpr int kMovingX = 20 + 70, kMovingY = 70 + 40;

}  // namespace

TEST_CASE("A map has the colour of what became of a point where the point is") {
  const TwoPointRun two;
  const KeptRun run = two.kept();
  const Canvas all = map_picture(run, half_metre("remove-all:default"), {});
  CHECK(all.at(kStaticX, kStaticY) == verdict_colours::kFalsePositive);
  CHECK(all.at(kMovingX, kMovingY) == verdict_colours::kTruePositive);
  const Canvas none = map_picture(run, half_metre("noop:default"), {});
  // Grey of a single point: 226 - 110 * log2(1 + 1) / 8 = 212.25.
  CHECK(none.at(kStaticX, kStaticY) == Colour{212, 212, 212});
  CHECK(none.at(kMovingX, kMovingY) == verdict_colours::kFalseNegative);
  CHECK(none.at(kMovingX + 1, kMovingY) == Colour{255, 255, 255});
  CHECK(none.at(kMovingX, kMovingY - 1) == Colour{255, 255, 255});
}

TEST_CASE("A cropped map shows its window only") {
  const TwoPointRun two;
  MapPictureOptions options = half_metre("remove-all:default");
  options.crop = WorldWindow{0, 60, -10, 50};
  const Canvas cropped = map_picture(two.kept(), options, {});
  // From above (0, 50): 5 m to the right, 40 m down to the moving point.
  CHECK(cropped.at(20 + 10, 70 + 80) == verdict_colours::kTruePositive);
}

TEST_CASE("A crop in which no point lies is refused with the place where the sensor was") {
  const TwoPointRun two;
  const KeptRun run = two.kept();
  const std::string says =
      "--crop 1000:2000:1000:2000: no point lies there. The sensor and 30 m around it are within "
      "-30:30:-30:30 (metres of the world frame).";
  MapPictureOptions map = half_metre("remove-all:default");
  map.crop = WorldWindow{1000, 2000, 1000, 2000};
  CHECK_THROWS_WITH(map_picture(run, map, {}), says);
  // One of the two points is enough.
  map.crop = WorldWindow{4, 9, 9, 14};
  CHECK_NOTHROW(map_picture(run, map, {}));
  // If no cell has a result, no point is searched.
  MapPictureOptions failed = half_metre("broken:default");
  failed.crop = WorldWindow{1000, 2000, 1000, 2000};
  CHECK_NOTHROW(map_picture(run, failed, {}));
}

TEST_CASE("The same pixels give the same PNG, with the size of the picture in its head") {
  Canvas first(300, 5), second(300, 5);
  for (Canvas* canvas : {&first, &second}) canvas->fill(2, 1, 40, 3, kInk);
  const std::string png = first.png_bytes();
  CHECK(png == second.png_bytes());
  CHECK_THAT(png, Catch::Matchers::StartsWith("\x89PNG\r\n"));
  // After the signature and the name of the first chunk, width and height as big-endian numbers.
  CHECK(png.substr(12, 12) == std::string("IHDR\0\0\x01\x2C\0\0\0\x05", 12));
}

TEST_CASE("A cell that failed is a hatched panel, beside others or alone") {
  const TwoPointRun two;
  MapPictureOptions options = half_metre("broken:default");
  options.only.push_back("noop:default");
  const Canvas image = map_picture(two.kept(), options, {});
  // Methods are in the order of the run; the stripes are the only pixels of this grey.
  std::size_t stripes = 0;
  for (int y = 70; y < 190; ++y) {
    for (int x = 0; x < image.width(); ++x) {
      stripes += image.at(x, y) == Colour{214, 214, 214} ? 1 : 0;
    }
  }
  CHECK(stripes > 500);
  CHECK_NOTHROW(map_picture(two.kept(), half_metre("broken:default"), {}));
}

TEST_CASE("Pictures of points say what they lack") {
  const TwoPointRun bare(false);
  const KeptRun run = bare.kept();
  CHECK_THROWS_WITH(map_picture(run, half_metre("noop:default"), {}),
                    Contains("two / noop:default") && Contains("--keep-removals"));
  CHECK_THROWS_WITH(map_picture(run, half_metre("nop*"), {}), Contains("nop*"));
  CHECK_THROWS_AS(KeptRun((bare.folder.path() / "nowhere").string(), ""), UsageError);
}

TEST_CASE("Removals that were changed are refused") {
  const TwoPointRun two;
  const KeptRun run = two.kept();
  const Sequence sequence = run.open("two", {});
  const KeptCell& cell = run.cell("two", "noop:default");
  CHECK(run.masks(cell, sequence).get(0) == Mask{0, 0});
  const std::uint32_t words[] = {251, 9};
  write_atomically(cell.removals / "000000.label",
                   {reinterpret_cast<const char*>(words), sizeof words});
  CHECK_THROWS_WITH(run.masks(cell, sequence), Contains("changed"));
}

TEST_CASE("A pixel goes by its moving points, unless they are few") {
  const auto shown = [](int found, int left, int lost, int kept) {
    TopDownRaster raster({0, 1, 0, 1}, 1.0);
    const std::pair<Outcome, int> all[] = {{Outcome::kTruePositive, found},
                                           {Outcome::kFalseNegative, left},
                                           {Outcome::kFalsePositive, lost},
                                           {Outcome::kKeptStatic, kept}};
    for (const auto& [outcome, points] : all) {
      for (int i = 0; i < points; ++i) raster.add({0.5, 0.5, 0.0}, outcome);
    }
    Outcome outcome = Outcome::kKeptStatic;
    CHECK(raster.shown(0, 0, outcome) == (found + left + lost + kept > 0));
    return outcome;
  };
  CHECK(shown(0, 0, 0, 0) == Outcome::kKeptStatic);
  CHECK(shown(1, 0, 0, 10) == Outcome::kTruePositive);
  CHECK(shown(1, 0, 0, 11) == Outcome::kKeptStatic);
  CHECK(shown(2, 2, 0, 10) == Outcome::kFalseNegative);
  CHECK(shown(3, 2, 20, 10) == Outcome::kTruePositive);
  CHECK(shown(0, 0, 2, 3) == Outcome::kKeptStatic);
  CHECK(shown(0, 0, 3, 3) == Outcome::kFalsePositive);
}

TEST_CASE("Cells of a map are half open, and what lies outside the window is left out") {
  TopDownRaster raster({0, 2, 0, 2}, 1.0);
  Outcome outcome = Outcome::kKeptStatic;
  raster.add({1.0, 1.0, 0.0}, Outcome::kTruePositive);  // x to the right column, y to the lower row
  CHECK(raster.shown(1, 1, outcome));
  raster.add({2.0, 0.5, 0.0}, Outcome::kTruePositive);
  raster.add({-0.1, 0.5, 0.0}, Outcome::kTruePositive);
  CHECK_FALSE(raster.shown(0, 1, outcome));
}

TEST_CASE("A run of somebody else makes no scene") {
  const TwoPointRun two;
  const EmptyCache cache(two.folder.path() / "cache");
  RunRecord record = read_run_record(two.run / "run.json");
  record.sequences.at(0).place->path = "town:scans=1,sensor=vlp16";
  write_run_record(two.run / "run.json", record);
  CHECK_THROWS_WITH(two.kept().open("two", {}), Contains("--simulate"));
  CHECK_FALSE(fs::exists(two.folder.path() / "cache"));
  // It is made on request, and then differs from the data of the run.
  CHECK_THROWS_WITH(KeptRun(two.run.string(), "", true).open("two", {}),
                    Contains("its fingerprint is another"));
  CHECK(fs::exists(two.folder.path() / "cache"));
  CHECK_THROWS_WITH(two.kept().open("two", {}), Contains("its fingerprint is another"));
}
