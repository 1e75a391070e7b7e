// SPDX-License-Identifier: MIT
// The files of results: bytes that are read and written again stay, and damage is named.
#include "benchmark/result/cell_json.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "benchmark/result/checks/differences.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/result/sealed_json.h"
#include "core/files/files.h"
#include "tests/benchmark/result/full_cell.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;
using test::full_cell;
namespace fs = std::filesystem;

namespace {

/// Draws the parts of random records.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  int below(int end) { return std::uniform_int_distribution(0, end - 1)(random_); }
  bool flip() { return below(2) == 0; }
  std::int64_t count() {
    // At most 53 bits, which every reader of JSON holds.
    return std::uniform_int_distribution<std::int64_t>()(random_) >> (10 + below(53));
  }
  /// Any finite number, also a negative zero or one with an exponent.
  double number() {
    for (;;) {
      const std::uint64_t bits = random_();
      double value = 0.0;
      std::memcpy(&value, &bits, sizeof value);
      if (flip()) value = static_cast<double>(below(1000)) / 8.0;
      if (std::isfinite(value)) return value;
    }
  }
  std::string text() {
    static const char* const kPieces[] = {"town",     " ", "\"",  "\\", "\n",
                                          "\xC3\x9F", ":", "0.5", "/"};
    std::string text;
    for (int i = below(5); i > 0; --i) text += kPieces[below(9)];
    return text;
  }
  std::string name(std::size_t i) { return text() + std::to_string(i); }
  /// What may name a sequence, method, protocol or suite, or nothing.
  std::string legal_name() {
    static const char* const kPieces[] = {"town", "\"", "\xC3\x9F", ":", "0.5", "<b>", "a b"};
    std::string name = flip() ? "" : "n";
    for (int i = name.empty() ? 0 : below(5); i > 0; --i) name += kPieces[below(7)];
    return name;
  }
  template <class Make>
  auto maybe(Make make) -> std::optional<decltype(make())> {
    if (flip()) return std::nullopt;
    return make();
  }
  template <class Make>
  auto some(Make make) {
    std::vector<decltype(make(std::size_t{}))> items;
    for (int i = below(4); i > 0; --i) items.push_back(make(items.size()));
    return items;
  }

  Configuration configuration() {
    return some([&](std::size_t i) -> std::pair<std::string, ParameterValue> {
      switch (below(4)) {
        case 0:
          return {name(i), flip()};
        case 1:
          return {name(i), count()};
        case 2:
          return {name(i), number()};
        default:
          return {name(i), text()};
      }
    });
  }
  DataRecord data() {
    DataRecord data{legal_name(), text(), text(), text(), static_cast<std::size_t>(below(5000)),
                    text(),       text(), text(), text(), text()};
    data.scan_period_s = maybe([&] { return number(); });
    data.range_m.min = number();
    if (flip()) data.range_m.max = std::min(number(), 1e299);
    data.drop_ego = maybe([&] { return EgoRecord{text(), text()}; });
    data.label_rule = maybe([&] {
      const auto id = [&](std::size_t) { return static_cast<std::uint16_t>(below(65536)); };
      return LabelRule{text(), some(id), some(id)};
    });
    data.T_sensor = text();
    data.time_offset_s = maybe([&] { return number(); });
    data.deskew = text();
    data.losses = some([&](std::size_t) { return text(); });
    data.fingerprint = text();
    return data;
  }
  ProtocolRecord protocol(std::size_t i) {
    return {legal_name(), legal_name(), name(i), configuration()};
  }
  Score score(std::size_t i) {
    Score score{protocol(i)};
    score.counts =
        some([&](std::size_t k) { return std::pair<std::string, std::int64_t>(name(k), count()); });
    score.rates = some([&](std::size_t k) {
      const auto value = maybe([&] { return number(); });
      return Rate{name(k), value, value ? "" : text()};
    });
    score.warnings = some([&](std::size_t) { return text(); });
    score.intervals = maybe([&] {
      Intervals intervals;
      intervals.options = {below(9), number(), random_()};
      intervals.block_scans = static_cast<std::size_t>(below(99));
      intervals.rates = some([&](std::size_t k) {
        const bool defined = flip();
        return defined ? Interval{name(k), number(), number()} : Interval{name(k), {}, {}, text()};
      });
      return intervals;
    });
    score.by_scan = some([&](std::size_t k) {
      const auto values = some([&](std::size_t) { return count(); });
      return std::pair<std::string, std::vector<std::int64_t>>(name(k), values);
    });
    return score;
  }
  Measurement measurement() {
    const auto maybe_number = [&] { return maybe([&] { return number(); }); };
    Measurement measured{below(99),      number(),       maybe_number(), maybe_number(),
                         maybe_number(), maybe_number(), number(),       number()};
    measured.stages = some([&](std::size_t) { return StageSeconds{text(), number()}; });
    measured.peak_memory_mib = maybe_number();
    measured.repeats = some([&](std::size_t) { return number(); });
    return measured;
  }
  Cell cell() {
    Cell cell{legal_name(), legal_name(), text(), static_cast<CellStatus>(below(5)),
              text(),       text()};
    cell.method = {legal_name(), legal_name(), text(), flip(), flip(), configuration()};
    cell.data = maybe([&] { return data(); });
    cell.scores = some([&](std::size_t i) { return score(i); });
    cell.columns = maybe([&] {
      return ColumnRecord{text(), some([&](std::size_t i) {
                            const std::int64_t whole = below(3);
                            return ColumnValue{name(i), {count(), whole}, whole > 0 ? "" : text()};
                          })};
    });
    cell.reliability = maybe([&] {
      Reliability said;
      for (ReliabilityBin& bin : said.bins) bin = {count(), count(), count()};
      return said;
    });
    cell.masks = maybe([&] { return MaskRecord{text(), count()}; });
    cell.measured = maybe([&] { return measurement(); });
    return cell;
  }
  RunRecord run() {
    RunRecord run{legal_name()};
    run.sequences = some([&](std::size_t) {
      SequenceRecord sequence{data()};
      sequence.place = maybe([&] { return SequenceRequest{text(), {}}; });
      return sequence;
    });
    run.methods = some([&](std::size_t i) {
      return SuiteMethodRecord{legal_name(), legal_name(), name(i), configuration(), maybe([&] {
                                 return SweepRecord{legal_name(), configuration()};
                               })};
    });
    run.protocols = some([&](std::size_t i) { return protocol(i); });
    run.controls = flip();
    run.cells = some([&](std::size_t) { return CellName{legal_name(), legal_name()}; });
    run.build = maybe([&] { return BuildRecord{text(), text(), text(), text(), text()}; });
    run.machine = maybe([&] {
      return MachineRecord{text(), below(99), maybe([&] { return count(); }), below(99)};
    });
    return run;
  }

 private:
  std::mt19937_64 random_;
};

/// The JSON text after it was read as a record and made anew.
template <class Read>
std::string again(const ordered_json& json, Read read) {
  const ordered_json parsed = ordered_json::parse(json.dump());
  const std::string file = "file.json";
  return to_json(read(parsed, file)).dump();
}

std::string error_of(const ordered_json& cell) {
  const std::string file = "somewhere/cell.json";
  try {
    (void)cell_from(cell, file);
  } catch (const FieldError& error) {
    return error.what();
  }
  return "";
}

using Pointer = ordered_json::json_pointer;

/// Every field of every object below `json`, with the names that stand for what is in them.
void collect_fields(const ordered_json& json, const Pointer& place, std::vector<Pointer>& places) {
  if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) collect_fields(json[i], place / i, places);
  }
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    places.push_back(place / key);
    collect_fields(value, place / key, places);
  }
}

bool may_be_missing(const Pointer& place) {
  const std::string text = place.to_string();
  for (const char* part :
       {"/parameters/", "/options/", "/counts/", "/rates/", "/undefined", "/values/"}) {
    const bool is_named = text.find(part) != std::string::npos;
    const bool of_column = std::string(part) == "/values/" && place.back() != "recall" &&
                           place.back() != "residue" && place.back() != "undefined";
    if (is_named && !of_column && place.back() != "undefined") return true;
    if (is_named && text.starts_with("/columns") && !of_column) return true;
  }
  static const std::vector<std::string> kOptional = {
      "schema_version", "key",          "data",
      "columns",        "confidence",   "masks",
      "measured",       "sensor_basis", "up",
      "up_source",      "max",          "scan_period_s",
      "drop_ego",       "label_rule",   "fingerprint",
      "intervals",      "median",       "p90",
      "early",          "late",         "peak_memory_mib",
      "repeats",        "T_sensor",     "time_offset_s",
      "deskew",         "losses"};
  return std::find(kOptional.begin(), kOptional.end(), place.back()) != kOptional.end();
}

}  // namespace

TEST_CASE("The reference is read and written byte for byte", "[result]") {
  const fs::path file = fs::path(RAYMOVAL_SOURCE_DIR) / "results/reference/street/results.json";
  const test::TemporaryFolder folder;
  const ResultsRecord results = read_results(file);
  CHECK(results.cells.size() > 10);
  write_results(folder.path() / "results.json", results);
  CHECK(read_text(folder.path() / "results.json") == read_text(file));
}

TEST_CASE("Random records have the same JSON after they were read", "[result]") {
  for (unsigned seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    const ordered_json cell = to_json(draw.cell());
    CHECK(again(cell, cell_from) == cell.dump());
    const ordered_json run = to_json(draw.run());
    CHECK(again(run, run_record_from) == run.dump());
    ResultsRecord record{draw.run(), draw.flip(), {draw.text()}, {}, {draw.cell(), draw.cell()}};
    record.missing = draw.some([&](std::size_t) { return draw.text(); });
    const ordered_json results = to_json(record);
    CHECK(again(results, results_from) == results.dump());
  }
}

TEST_CASE("A field that is missing or of another type is named with its file", "[result]") {
  const ordered_json whole = full_cell();
  REQUIRE(error_of(whole).empty());
  std::vector<Pointer> places;
  collect_fields(whole, Pointer(), places);
  CHECK(places.size() > 70);
  for (const Pointer& place : places) {
    if (place.back() == "schema_version") continue;  // Of whole files, see below.
    INFO(place.to_string());
    ordered_json mistyped = whole;
    mistyped[place] = ordered_json::array({ordered_json::array({ordered_json::array()})});
    CHECK_THAT(error_of(mistyped), Contains("somewhere/cell.json: ") && Contains(place.back()));
    ordered_json missing = whole;
    missing[place.parent_pointer()].erase(place.back());
    if (may_be_missing(place)) {
      CHECK(error_of(missing).empty());
    } else {
      CHECK_THAT(error_of(missing),
                 Contains("somewhere/cell.json: ") && Contains(place.back() + ": is missing"));
    }
  }
}

TEST_CASE("Rates and intervals that no cell has are refused", "[result]") {
  ordered_json cell = full_cell();
  cell[Pointer("/protocols/0/intervals/rates/PR")] = {1.0};
  CHECK_THAT(error_of(cell), Contains("expected two numbers"));
  cell = full_cell();
  cell[Pointer("/protocols/0/rates/PR")] = "90";
  CHECK_THAT(error_of(cell), Contains("protocols[0].rates.PR: expected a number, found \"90\""));
}

TEST_CASE("A file of another version, or a list of places that does not fit, is refused",
          "[result]") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "run.json";
  RunRecord run{"quick"};
  run.sequences = {{DataRecord{"town"}, SequenceRequest{"town", {}}}};
  write_run_record(file, run);
  CHECK(read_run_record(file).sequences.at(0).place.value().path == "town");
  ordered_json json = read_sealed(file);
  json["places"][0]["frames"] = "one:two";
  write_sealed(file, json);
  CHECK_THROWS_WITH(read_run_record(file), Contains("run.json") && Contains("places[0]"));
  json["places"] = {nullptr, nullptr};
  write_sealed(file, json);
  CHECK_THROWS_WITH(read_run_record(file), Contains("places"));
  json["schema_version"] = 2;
  write_sealed(file, json);
  CHECK_THROWS_AS(read_run_record(file), SchemaVersionError);
  CHECK_THROWS_WITH(read_run_record(file), Contains("schema version 2, expected 1"));
}

TEST_CASE("Other people's results have no name that would be more than a name", "[result]") {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "results.json";
  const auto error_with = [&](const std::string& name, int place) {
    ResultsRecord results{RunRecord{"quick"}};
    const auto at = [&](int here) { return place == here ? name : std::string("town"); };
    results.run.suite = at(0);
    results.run.sequences = {{DataRecord{at(1)}, std::nullopt}};
    results.run.methods = {{at(2), at(3), "1", {}, SweepRecord{at(4), {}}}};
    results.run.protocols = {{at(5), at(6), "1", {}}};
    Cell cell{at(7), at(8), "", CellStatus::kOk, "", ""};
    cell.method = {at(9), at(10), "1", false, false, {}};
    results.cells = {cell};
    write_results(file, results);
    try {
      (void)read_results(file);
    } catch (const DataError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(error_with("=1", -1).empty());
  for (const std::string name : {"=1+1", "-x", "@a", " a", "../x", "\x1b[2J",
                                 "\xe2\x80\xae"
                                 "x",
                                 "a\nb"}) {
    for (int place = 0; place <= 10; ++place) {
      INFO(name << " at " << place);
      CHECK_THAT(error_with(name, place), Contains("the name "));
    }
  }
}

TEST_CASE("Files of earlier versions are read", "[result]") {
  ordered_json run = to_json(RunRecord{"quick"});
  run["suite"]["sequences"].push_back(to_json(DataRecord{"town"}));
  for (const char* name : {"x", "y"}) {
    run["suite"]["methods"].push_back({{"name", name},
                                       {"method", name},
                                       {"version", "1"},
                                       {"parameters", ordered_json::object()}});
  }
  run.erase("cells");
  run.erase("places");
  run["suite"]["protocols"].push_back(
      {{"name", "erasor"}, {"protocol", "erasor"}, {"options", ordered_json::object()}});
  run["build"] = {{"version", "0"}, {"compiler", "c"}, {"build_type", "t"}};
  const std::string file = "run.json";
  const RunRecord read = run_record_from(run, file);
  // Each sequence goes with each method, and nobody knows where the sequence is.
  CHECK(read.cells == std::vector<CellName>{{"town", "x"}, {"town", "y"}});
  CHECK_FALSE(read.sequences[0].place);
  CHECK(read.build->commit.empty());
  CHECK(read.protocols.at(0).version.empty());

  ordered_json old = full_cell();
  for (const char* key : {"columns", "masks"}) old.erase(key);
  for (const char* key : {"up", "up_source", "drop_ego", "T_sensor", "time_offset_s", "deskew", "losses"})
    old["data"].erase(key);
  for (const char* key : {"early", "late"}) old["measured"]["seconds_per_scan"].erase(key);
  old["protocols"][0].erase("intervals");
  const Cell cell = cell_from(old, file);
  CHECK_FALSE(cell.columns);
  CHECK(cell.data->up.empty());
  CHECK(comparison_facts(cell).count("data up") == 0);  // They took z.
  CHECK_FALSE(cell.measured->early_seconds);
}
