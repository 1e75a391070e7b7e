// SPDX-License-Identifier: MIT
// A layout that is not built in. To be opened, inspected, run and cleaned like others, it needs
// only this file; one line registers it.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "benchmark/clean/clean_outputs.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/runner.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/file_source.h"
#include "datasets/inspection/inspect.h"
#include "datasets/layouts.h"
#include "datasets/open_sequence.h"
#include "datasets/settings.h"
#include "methods/registry.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

/// Text files NNNNNN.toy: a line with the sensor's position, then a line `x y z label` for each
/// point.
class ToyScans : public ScanSource, public LabelSource {
 public:
  explicit ToyScans(std::vector<NumberedFile> files) : files_(std::move(files)) {}
  [[nodiscard]] std::size_t size() const override { return files_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override {
    Scan scan;
    scan.index = index;
    scan.name = files_[index].path.stem().string();
    scan.time_s = 0.1 * static_cast<double>(index);
    scan.T_world_sensor = pose(index);
    const auto rows = rows_of(index);
    for (std::size_t i = 1; i < rows.size(); ++i) {
      scan.points.push_back(Eigen::Vector3d(rows[i][0], rows[i][1], rows[i][2]).cast<float>());
    }
    scan.stored_point_count = scan.size();
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t index) const override {
    const std::vector<double> at = rows_of(index).front();
    return Pose(Eigen::Translation3d(at[0], at[1], at[2]));
  }
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    const auto rows = rows_of(scan.index);
    std::vector<std::uint32_t> words;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      words.push_back(static_cast<std::uint32_t>(rows[i][3]));
    }
    return words;
  }
  [[nodiscard]] const SensorModel& sensor() const override {
    return sensor_.get(size(), [this](std::size_t index) { return load(index); });
  }

 private:
  [[nodiscard]] std::vector<std::vector<double>> rows_of(std::size_t index) const {
    std::vector<std::vector<double>> rows;
    const std::string text = read_text(files_[index].path);
    for (const std::string_view line : split(text, '\n')) {
      if (line.empty()) continue;
      rows.emplace_back();
      for (const auto word : split(line, ' ')) {
        rows.back().push_back(parse_number<double>(word).value());
      }
    }
    return rows;
  }
  std::vector<NumberedFile> files_;
  SensorChoice sensor_{std::nullopt};
};

Layout toy_layout() {
  Layout layout;
  layout.name = "toy";
  layout.expected = "a toy sequence (*.toy)";
  layout.forms = {{"FOLDER", "a folder in toy layout (*.toy)"}};
  layout.class_names = {{252, "toy-car"}};
  layout.recognise = [](Layout::Path path) {
    return is_folder(path) && !list_files(path, {".toy"}).empty();
  };
  layout.open = [](Layout::Path path, const SequenceOptions& options, const OpenContext&) {
    const SequenceSettings settings = read_settings(path, options, {});
    const ChosenFrames chosen =
        choose_frames(list_numbered_files(path, ".toy"), settings.frames, path);
    Sequence sequence = make_sequence(settings, toy_layout(), chosen.range);
    const auto scans = std::make_shared<const ToyScans>(chosen.files);
    sequence.scans = scans;
    sequence.labels = scans;
    return sequence;
  };
  return layout;
}

const bool registered = (register_layout(toy_layout()), true);

SequenceOptions first_scans() {
  SequenceOptions options;
  options.frames = parse_frame_range("0:4");
  return options;
}

/// The street in the toy's form.
std::string write_toy(const test::TemporaryFolder& folder) {
  const Sequence street = open_sequence("street", first_scans());
  const std::filesystem::path toy = folder.path() / "toys";
  std::filesystem::create_directory(toy);
  for (std::size_t i = 0; i < street.scans->size(); ++i) {
    const Scan scan = street.scans->load(i);
    const std::vector<std::uint32_t> words = street.labels->labels(scan);
    const Eigen::Vector3d at = scan.T_world_sensor.translation();
    std::ofstream file(toy / (scan.name + ".toy"));
    file << number_text(at.x()) << ' ' << number_text(at.y()) << ' ' << number_text(at.z()) << '\n';
    for (std::size_t k = 0; k < scan.size(); ++k) {
      for (const float value : scan.points[k]) {
        file << number_text(static_cast<double>(value)) << ' ';
      }
      file << words[k] << '\n';
    }
  }
  return toy.string();
}

}  // namespace

TEST_CASE("A layout of a program's own is opened and listed like any other") {
  REQUIRE(registered);
  const test::TemporaryFolder folder;
  const std::string path = write_toy(folder);
  const Sequence sequence = open_sequence(path, {});
  CHECK(sequence.layout == "toy");
  CHECK(sequence.name == "toys");
  CHECK(sequence.frames == "0:4:1");
  CHECK(sequence.label_rule.class_name(252) == "toy-car");
  CHECK(sequence.label_rule.class_name(40) == "label-40");
  CHECK(&layout_of(sequence) == recognised_layout(path));
  const Scan scan = sequence.scans->load(3);
  CHECK(scan.points == open_sequence("street", {}).scans->load(3).points);
  CHECK_THROWS_WITH(open_sequence(folder.path().string(), {}), Contains("a toy sequence (*.toy)"));
  CHECK_THROWS_WITH(register_layout(toy_layout()), Contains("already a layout 'toy'"));
}

TEST_CASE("A layout of a program's own is inspected like any other", "[slow]") {
  const test::TemporaryFolder folder;
  const InspectionReport report = inspect_path(write_toy(folder), {});
  CHECK(report.layout == "toy");
  CHECK(report.scans == 5);
  CHECK_FALSE(report.has_findings());
}

TEST_CASE("A layout of a program's own is run, with the counts of the same data elsewhere",
          "[slow]") {
  const test::TemporaryFolder folder;
  Suite suite;
  suite.sequences = {{"street", first_scans()}, {write_toy(folder), {}}};
  add_protocol(suite, "erasor", "");
  add_controls(suite, MethodRegistry::built_in());
  suite.threads = 1;
  const auto out = folder.path() / "run";
  CHECK(run_suite(suite, {.out = out}).good());
  for (const char* method : {"noop-default", "oracle-default"}) {
    const auto street = read_sealed(out / "cells/street" / method / "cell.json");
    const auto toy = read_sealed(out / "cells/toys" / method / "cell.json");
    CHECK(toy.at("data").at("layout") == "toy");
    CHECK(toy.at("protocols")[0].at("counts") == street.at("protocols")[0].at("counts"));
  }
}

TEST_CASE("A layout of a program's own is cleaned like any other") {
  const test::TemporaryFolder folder;
  const Sequence sequence = open_sequence(write_toy(folder), {});
  CleanPaths paths;
  paths.map = folder.path() / "map.pcd";
  check_apart_from(sequence, paths);
  Progress progress(ProgressStyle::kQuiet);
  const std::atomic<bool> cancel{false};
  CleanOutputs outputs(paths, {}, sequence, progress, cancel);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    const Scan scan = sequence.scans->load(i);
    Mask mask;
    for (const std::uint32_t word : sequence.labels->labels(scan)) {
      mask.push_back(sequence.label_rule.classify(word) == LabelClass::kMoving ? 1 : 0);
      kept += mask.back() == 0 ? 1 : 0;
    }
    outputs.add(scan, mask);
  }
  outputs.commit();
  CHECK(read_cloud(paths.map).points.size() == kept);
}
