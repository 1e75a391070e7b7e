// SPDX-License-Identifier: MIT
#include <algorithm>
#include <catch2/catch.hpp>

#include "core/error.h"
#include "eval/comparison/compare.h"
#include "eval/points/cloud_masks.h"
#include "tests/eval/memory_sequence.h"
#include "tests/eval/toy_protocol.h"

namespace raymoval::test {
namespace {

/// A car, a truck and road, seen twice.
MemorySequence small_street() {
  LabelledScan scan;
  for (int i = 0; i < 12; ++i) {
    const std::uint32_t label = i < 6 ? 40 : i < 9 ? 252 : 258;
    scan.add(5.0F + static_cast<float>(i), 1.0F, 0.0F, label, i % 4 == 0);
  }
  LabelledScan later = scan;
  later.pose.translation().x() = 1.0;
  return MemorySequence({scan, later});
}

bool is_listed(const std::string& name, const auto& specs) {
  return std::any_of(specs.begin(), specs.end(),
                     [&](const auto& spec) { return spec.name == name; });
}

void check_listed(const ProtocolResult& result, const ProtocolEntry& entry) {
  for (const auto& [name, count] : result.counts) {
    CAPTURE(name);
    CHECK(is_listed(name, entry.counts));
  }
  for (const Rate& rate : result.rates) {
    CAPTURE(rate.name);
    CHECK(is_listed(rate.name, entry.rates));
  }
}

std::vector<std::string> names_of(const std::vector<RateSpec>& specs, bool secondary) {
  std::vector<std::string> names;
  for (const RateSpec& spec : specs) {
    if ((spec.role == RateRole::kSecondary) == secondary) names.push_back(spec.name);
  }
  return names;
}

}  // namespace

TEST_CASE("every built-in protocol lists its rates and counts", "[registry]") {
  const MemorySequence sequence = small_street();
  const std::vector<Eigen::Vector3f> points = {{5.0F, 1.0F, 0.0F}, {14.0F, 1.0F, 0.0F}};
  for (const ProtocolEntry& entry : protocol_entries()) {
    CAPTURE(entry.name);
    Configuration options = protocol_defaults(entry.name);
    check_listed(
        make_protocol(entry.name, options)->open(sequence.input())->score(sequence.masks()), entry);
    for (const auto& [key, value] : entry.cloud_options) set_parameter(options, key, value);
    const auto scorer = make_protocol(entry.name, options)->open(sequence.input());
    check_listed(scorer->score_cloud(CloudEstimate(points)), entry);
    CHECK(scorer->score(sequence.masks()).protocol == entry.name);
  }
}

TEST_CASE("a count of the truth is the same for every mask", "[registry]") {
  const MemorySequence sequence = small_street();
  for (const ProtocolEntry& entry : protocol_entries()) {
    const auto scorer = protocol_with(entry.name)->open(sequence.input());
    const ProtocolResult some = scorer->score(sequence.masks());
    const ProtocolResult all = scorer->score(sequence.constant_masks(true));
    for (const auto& [name, count] : some.counts) {
      CAPTURE(entry.name, name);
      if (is_truth_count(name)) CHECK(all.count(name) == count);
    }
  }
}

TEST_CASE("known answers have the rates that the protocols say", "[registry]") {
  const MemorySequence sequence = small_street();
  const std::vector<std::pair<KnownAnswer, MaskStore>> answers = {
      {KnownAnswer::kNothingRemoved, sequence.constant_masks(false)},
      {KnownAnswer::kEverythingRemoved, sequence.constant_masks(true)},
      {KnownAnswer::kMovingPointsRemoved, sequence.oracle_masks()}};
  int checked = 0;
  for (const ProtocolEntry& entry : protocol_entries()) {
    const auto scorer = protocol_with(entry.name)->open(sequence.input());
    for (const auto& [answer, masks] : answers) {
      const ProtocolResult result = scorer->score(masks);
      for (const RateSpec& spec : entry.rates) {
        if (!spec.expected(answer)) continue;
        CAPTURE(entry.name, spec.name);
        CHECK(result.rate(spec.name) == spec.expected(answer));
        ++checked;
      }
    }
  }
  CHECK(checked == 5 + 5 + 5 + 6);
}

TEST_CASE("a protocol, a rate or a count that is not there is told", "[registry]") {
  CHECK_THROWS_WITH(protocol_entry("erasr"),
                    Catch::Contains("'erasr' is unknown") && Catch::Contains("erasor"));
  CHECK(find_protocol("erasr") == nullptr);
  CHECK(find_protocol("erasor") == &protocol_entries().front());
  ProtocolResult result;
  result.protocol = "erasor";
  result.counts = {{"a", 3}, {"b", 4}};
  CHECK(result.count("b") == 4);
  CHECK_THROWS_AS(result.count("c"), InternalError);
  CHECK_FALSE(result.rate("c"));
}

TEST_CASE("a protocol that reads a calibration says which option wants it", "[registry]") {
  const MemorySequence sequence = small_street();
  const auto protocol = protocol_with("erasor", {{"frame", std::string("erasor")}, {"lift", 0.5}});
  CHECK(protocol->reads_calibration());
  CHECK_FALSE(protocol_with("erasor")->reads_calibration());
  CHECK_FALSE(protocol_with("dynamicmap")->reads_calibration());
  CHECK_THROWS_WITH(protocol->check(sequence.input()),
                    Catch::Contains("(lift = 0.5, frame = erasor)"));
  const Settings first = {{"frame", std::string("erasor")}, {"voxel_size", 0.3}};
  CHECK_THROWS_WITH(protocol_with("erasor", first)->check(sequence.input()),
                    Catch::Contains("(voxel_size = 0.3, frame = erasor)"));
  CHECK(protocol->version() == protocol_entry("erasor").version);
  CHECK_FALSE(protocol->version().empty());
  EvaluationInput calibrated = sequence.input();
  calibrated.T_camera_lidar = Pose::Identity();
  CHECK_NOTHROW(protocol->check(calibrated));
  EvaluationInput nothing;
  CHECK_THROWS_AS(protocol->check(nothing), InternalError);
}

TEST_CASE("labels that are found again make the oracle uncertain", "[registry]") {
  const ProtocolEntry& erasor = protocol_entry("erasor");
  Configuration options = protocol_defaults("erasor");
  CHECK_FALSE(erasor.oracle_is_uncertain(options));
  set_parameter(options, "label_rule", std::string("geometry"));
  CHECK(erasor.oracle_is_uncertain(options));
  set_parameter(options, "label_rule", std::string("both"));
  set_parameter(options, "label_mode", std::string("nearest"));
  CHECK(erasor.oracle_is_uncertain(options));
}

TEST_CASE("a protocol that contradicts another is refused", "[registry]") {
  ProtocolEntry entry = toy_protocol_entry();
  entry.name = "erasor";
  CHECK_THROWS_AS(register_protocol(entry), ConfigurationError);
  entry = toy_protocol_entry();
  entry.rates[0].name = "PR";  // Which is in percent, and higher is better.
  CHECK_THROWS_WITH(register_protocol(entry), Catch::Contains("'PR'"));
  entry = toy_protocol_entry();
  entry.counts[2].name = "static_voxels";  // Which masks cannot change.
  CHECK_THROWS_WITH(register_protocol(entry), Catch::Contains("'static_voxels'"));
  entry = toy_protocol_entry();
  entry.rates[2].formula = RateFormula{"left", "PR", "sum", nullptr};
  CHECK_THROWS_WITH(register_protocol(entry), Catch::Contains("'PR'"));
  CHECK(protocol_entries().size() == 4);
  CHECK(names_of(rate_specs(), false).size() == 10);
}

TEST_CASE("where lower is better a rise of a rate is worse and a fall better", "[registry]") {
  const RegisteredToy toy;
  const auto cell_with = [](double mistakes) {
    ComparedCell cell;
    cell.sequence = "s";
    cell.name = "m";
    ComparedScore score;
    score.protocol = "toy";
    score.counts = {{"toy_static", 1000}, {"toy_lost", static_cast<std::int64_t>(1000 * mistakes)}};
    score.rates = {{"mistakes", mistakes}};
    cell.scores = {score};
    return cell;
  };
  const auto compared = [&](double run, double reference, const ComparisonOptions& options = {}) {
    return compare_results({{cell_with(run)}, {}}, {{cell_with(reference)}, {}}, options);
  };
  CHECK(compared(0.10, 0.10).same_cells == 1);
  CHECK_THAT(compared(0.12, 0.10).worse.at(0), Catch::Contains("mistakes 0.1000 -> 0.1200"));
  CHECK_THAT(compared(0.08, 0.10).better.at(0), Catch::Contains("mistakes 0.1000 -> 0.0800"));
  CHECK(compared(0.08, 0.10).verdict() == ExitCode::kDone);
  const ComparisonOptions tolerant{{{"mistakes", 0.03}}, {}};
  CHECK(compared(0.12, 0.10, tolerant).verdict() == ExitCode::kDone);
  CHECK_THAT(compared(0.14, 0.10, tolerant).worse.at(0), Catch::Contains("at most +0.03"));
  ComparedCell other = cell_with(0.08);
  other.scores[0].counts[0].second = 999;  // Of the truth.
  CHECK(compare_results({{other}, {}}, {{cell_with(0.10)}, {}}, {}).verdict() == ExitCode::kWorse);
}

}  // namespace raymoval::test
