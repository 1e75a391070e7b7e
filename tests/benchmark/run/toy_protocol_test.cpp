// SPDX-License-Identifier: MIT
// A protocol that is not built in, whose rates are fractions of mistakes (lower is better), in
// every output. Only its registration describes it.
#include <algorithm>
#include <catch2/catch.hpp>

#include "benchmark/harness.h"
#include "benchmark/result/checks/controls_check.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/run/runner.h"
#include "benchmark/tables/cell_line.h"
#include "benchmark/tables/tables.h"
#include "core/files/files.h"
#include "methods/controls/controls.h"
#include "tests/benchmark/comb.h"
#include "tests/benchmark/small_world.h"
#include "tests/eval/toy_protocol.h"

using namespace raymoval;
using Catch::Matchers::Contains;

namespace {

const MethodRegistry& methods() {
  static const MethodRegistry registry = [] {
    MethodRegistry made;
    for (MethodEntry entry : {noop_entry(), remove_all_entry(), oracle_entry()}) made.add(entry);
    MethodEntry thin = noop_entry();
    thin.name = "thin";
    thin.parameters = {{"step", std::int64_t{10}, {.minimum = 1.0}, {}}};
    thin.variants = {{"v", "", true, {}}};
    thin.make = [](const Configuration& values) {
      return std::make_unique<test::Comb>(
          static_cast<std::size_t>(std::get<std::int64_t>(values.front().second)));
    };
    made.add(thin);
    return made;
  }();
  return registry;
}

/// Two scans of the street, with a sweep of the method and both protocols.
void run_street(const std::filesystem::path& out, const std::string& step,
                const std::string& more = "") {
  const std::filesystem::path file = out.string() + "-suite.json";
  write_atomically(file, R"({"sequences": [{"path": "street", "frames": "0:1"}], "methods":
    [{"method": "thin", "as": "thin", "set": {"step": )" +
                             step + "}}" + more + R"(],
    "protocols": ["toy", "erasor"], "controls": true})");
  RunOptions options;
  options.out = out;
  Suite suite = read_suite(file, methods(), "");
  add_controls(suite, methods());
  const RunSummary summary = run_suite(suite, options);
  CHECK(summary.controls.empty());
  REQUIRE(summary.good());
}

/// What the program prints to a file, with the exit code that is expected.
std::string output_of(ExitCode expected, std::vector<const char*> arguments,
                      const std::filesystem::path& file) {
  arguments.insert(arguments.begin(), "raymoval");
  arguments.insert(arguments.end(), {"--overwrite", "-o"});
  const std::string path = file.string();
  arguments.push_back(path.c_str());
  CHECK(run_command_line(static_cast<int>(arguments.size()), arguments.data(), methods()) ==
        static_cast<int>(expected));
  return read_text(file);
}

/// The part of a text from `begin` to the next empty line.
std::string part_from(const std::string& text, const std::string& begin) {
  const std::size_t at = text.find(begin);
  REQUIRE(at != std::string::npos);
  return text.substr(at, text.find("\n\n", text.find("|\n", at)) - at);
}

}  // namespace

TEST_CASE("A protocol of one's own is in every output", "[slow]") {
  const test::RegisteredToy toy;
  const test::TemporaryFolder folder;
  const std::filesystem::path out = folder.path() / "run";
  run_street(out, "10",
             R"(, {"method": "thin", "as": "swept", "set": {"step": {"sweep": [5, 20]}}})");
  const std::string run = out.string();

  // The line in the log: the headline rate, the time, then what is kept and removed.
  const ResultsRecord record = read_results(out / "results.json");
  const Cell* cell = record.find({"street", "thin"});
  REQUIRE(cell != nullptr);
  const std::string line = CellLines({"street"}, {"thin"}, 1).line(1, *cell);
  CHECK_THAT(line, Contains("mistakes 0.1") && Contains(" ms  lost 0.1") && Contains("left 0."));
  CHECK_THAT(line, !Contains("lost_of_all"));

  // CSV: its main rates are behind those of the built-in protocols.
  const std::string csv = read_text(out / "results.csv");
  CHECK_THAT(csv, Contains("PR,RR,F1,SA,DA,AA,HA,precision,recall,IoU,lost,left,mistakes,parked,"
                           "trails,seconds_per_scan"));
  CHECK_THAT(csv, Contains("street,thin,v,toy,ok,,,,,,,,,,,0.1"));

  // Tables: the fewest mistakes are the best, also in the sweep.
  const std::string tables = read_text(out / "table.md");
  std::string words = tables;  // Notes are broken into lines.
  std::replace(words.begin(), words.end(), '\n', ' ');
  CHECK_THAT(words, Contains("Accuracy by protocol toy") && Contains("Controls by protocol toy") &&
                        Contains("lost and left and mistakes as a fraction; lower is better for") &&
                        Contains("mistakes counts left and lost points together."));
  CHECK_THAT(part_from(tables, "## Sweep of swept over step by protocol toy"),
             Contains("step=20") && Contains("**0.0"));
  CHECK_THAT(read_text(out / "table.tex"), Contains("mistakes"));
  RunResults results = shown_results(record);
  CHECK_THAT(tables_latex(make_tables(results)), Contains("mistakes") && Contains("\\textbf{0."));
  TableOptions options;
  options.rates = {"lost_of_all", "PR"};
  options.sort = "lost_of_all";
  CHECK_NOTHROW(check_rates(options, results));
  const TextTable by_request = make_tables(results, options).front();
  CHECK(by_request.groups.front().columns == std::vector<std::string>{"lost_of_all"});

  // Charts: both rates run towards 0, up and right, and no lines of an equal mean are drawn.
  for (const char* kind : {"pr-rr", "accuracy-time"}) {
    const std::string svg =
        output_of(ExitCode::kDone, {"picture", run.c_str(), "--kind", kind, "--protocol", "toy"},
                  folder.path() / "chart.svg");
    CHECK_THAT(svg, Contains("protocol toy") && Contains("thin"));
    CHECK_THAT(svg, !Contains("dotted") && !Contains(", %"));
  }
  const std::string page =
      output_of(ExitCode::kDone, {"report", run.c_str(), "--no-points", "--quiet"},
                folder.path() / "report.html");
  CHECK_THAT(page, Contains("toy, mean") && Contains("lower is better for") &&
                       Contains("lost against left by protocol toy"));
  // The method with the fewest mistakes comes first in the table.
  const std::size_t table = page.find("Each method over all sequences");
  REQUIRE(table != std::string::npos);
  const std::size_t first = page.find("step=<wbr>20<", table), second = page.find(">thin<", table);
  CHECK(first < second);
  CHECK(second < page.find("step=<wbr>5<", table));

  // A rise is worse, and a fall is better: with more points removed more static ones are lost.
  const std::filesystem::path worse = folder.path() / "worse", better = folder.path() / "better";
  run_street(worse, "5");
  run_street(better, "20");
  run_street(folder.path() / "same", "10");
  const std::string same = (folder.path() / "same").string();
  const auto compared = [&](ExitCode expected, const std::filesystem::path& other,
                            std::vector<const char*> more) {
    const std::string path = other.string();
    more.insert(more.begin(), {"compare", path.c_str(), same.c_str(), "--across", "parameters"});
    return output_of(expected, more, folder.path() / "compared.txt");
  };
  CHECK_THAT(compared(ExitCode::kWorse, worse, {"--tolerance", "mistakes=0.01"}),
             Contains("thin, toy: ") && Contains("at most +0.01 is allowed"));
  CHECK_THAT(
      compared(ExitCode::kDone, worse, {"--tolerance", "mistakes=0.9", "--tolerance", "PR=99"}),
      Contains("Moved"));
  CHECK_THAT(
      compared(ExitCode::kDone, better, {"--tolerance", "mistakes=0", "--tolerance", "PR=0"}),
      Contains("mistakes 0.1"));
}

TEST_CASE("The controls of a protocol of one's own are checked") {
  const test::RegisteredToy toy;
  Cell cell{.sequence = "street", .name = "noop:default", .key = ""};
  cell.method.name = "noop";
  cell.method.control = true;
  cell.scores = {{.protocol = {"mine", "toy", "1"}, .rates = {{"lost", 0.0}, {"left", 1.0}}}};
  CHECK(check_controls({cell}).empty());
  cell.scores[0].rates[1].value = 0.5;
  CHECK_THAT(check_controls({cell}).at(0), Contains("protocol mine: left is 0.5, must be 1"));
}
