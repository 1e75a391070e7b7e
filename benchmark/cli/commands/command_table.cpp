// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/result/run_record_json.h"
#include "benchmark/tables/published_columns.h"
#include "benchmark/tables/tables.h"
#include "core/terminal_colour.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct TableFlags {
  std::string run, format = "md", layout = "methods";
  std::vector<std::string> what, protocols, only, rates, decimals;
  std::string sort;
  bool with_published = false;
};

[[nodiscard]] bool is_text(const TableFlags& flags) {
  return flags.format == "md" || flags.format == "tex";
}

void check_word(const std::string& option, const std::string& word,
                const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  throw UsageError(option + " " + word + " is unknown." + suggestion(word, known));
}

void check_flags(const TableFlags& flags) {
  if (flags.run.empty()) throw UsageError("RUN is missing: expected `raymoval table RUN`.");
  check_word("--format", flags.format, {"md", "csv", "tex", "json"});
  check_word("--layout", flags.layout, {"methods", "paper"});
  const struct {
    const char* option;
    bool given;
  } looks[] = {{"--with-published", flags.with_published},
               {"--layout", flags.layout != "methods"},
               {"--rates", !flags.rates.empty()},
               {"--decimals", !flags.decimals.empty()},
               {"--what", !flags.what.empty()}};
  for (const auto& look : looks) {
    if (look.given && !is_text(flags)) {
      throw UsageError(std::string(look.option) + " needs --format md or tex.");
    }
  }
  if (flags.format == "json" &&
      !(flags.protocols.empty() && flags.only.empty() && flags.sort.empty())) {
    throw UsageError("--protocol, --only and --sort need --format md, csv or tex.");
  }
}

/// The papers' rows. Prints the sequences for which no row is comparable with the run's.
/// @throws UsageError if there is no other sequence
std::vector<OutsideColumn> matching_published_rows(const RunResults& results) {
  std::vector<OutsideColumn> papers = published_columns();
  const std::vector<std::string> reasons = set_beside(papers, results);
  if (reasons.size() == results.sequences.size()) {
    throw UsageError("--with-published: published rows are shown for the same frames only. " +
                     join(reasons, ". ") +
                     ". Leave the option out, or run the suite `semantickitti` or `kth`, which "
                     "have the papers' frames.");
  }
  for (const std::string& reason : reasons) {
    print_error("raymoval: --with-published: " + reason + ".");
  }
  return papers;
}

TableOptions options_of(const TableFlags& flags, const RunResults& results) {
  TableOptions options;
  options.layout = flags.layout == "paper" ? TableLayout::kSequenceRows : TableLayout::kMethodRows;
  for (const std::string& text : flags.rates) {
    for (const std::string_view rate : split(text, ',')) options.rates.emplace_back(rate);
  }
  for (const std::string& text : flags.decimals) parse_decimals(text, options);
  std::vector<std::string> kinds = table_kinds();
  kinds.emplace_back("all");
  for (const std::string& text : flags.what) {
    for (const std::string_view kind : split(text, ',')) {
      options.what.emplace_back(kind);
      check_word("--what", options.what.back(), kinds);
    }
  }
  if (options.what.empty() && flags.format == "tex") options.what = latex_kinds(results);
  if (is_among(options.what, "all")) options.what.clear();
  if (!flags.sort.empty()) options.sort = flags.sort;
  if (flags.with_published) options.outside = matching_published_rows(results);
  check_rates(options, results);
  return options;
}

std::string tables_text(const TableFlags& flags, RunResults& results) {
  TableOptions options = options_of(flags, results);
  sort_results(options.sort, results);
  if (flags.format == "csv") return results_csv(results);
  const std::vector<TextTable> tables = make_tables(results, options);
  if (tables.empty() && !flags.what.empty()) {
    throw UsageError("--what " + join(flags.what, ",") +
                     ": this run has no such table. `--what published` needs --with-published.");
  }
  return flags.format == "md" ? tables_markdown(results, tables) : tables_latex(tables);
}

ExitCode show(const TableFlags& flags) {
  check_flags(flags);
  const std::filesystem::path file = find_results(flags.run);
  if (flags.format == "json") {
    print(read_results_text(file));
    return ExitCode::kDone;
  }
  ResultsRecord record = read_results(file);
  choose_cells(record, flags.only);
  RunResults results = shown_results(record);
  choose_protocols(results, flags.protocols);
  print(tables_text(flags, results));
  return ExitCode::kDone;
}

void add_look_options(CommandOptions& options, TableFlags& flags) {
  options.add("--layout", "LAYOUT", flags.layout,
              "methods (default): a row for each method, a block for each sequence; paper: a "
              "row for each sequence, methods side by side");
  options.add("--rates", "RATES", flags.rates,
              "Show only these rates, in this order, such as PR,RR,F1; ms is the time per scan "
              "(default: the main rates)");
  options.add("--decimals", "N", flags.decimals,
              "Number of decimals: 2, or for one rate, such as F1=3");
  options.add("--sort", "COLUMN", flags.sort,
              "Sort every table by this rate, by ms or by MiB, best first, or by name; none "
              "(default): order of the run");
}

}  // namespace

Command add_table_command(CommandParser& program) {
  auto flags = std::make_shared<TableFlags>();
  CommandOptions options = program.add_command("table", "Prints the tables of a run");
  options.add("run", "RUN", flags->run, "The run folder");
  options.add("--format", "FORMAT", flags->format, "md (default), csv, tex or json");
  options.add("--what", "KIND", flags->what,
              "Show only these tables: " + join(table_kinds()) +
                  ", or all but columns, losses and intervals (all, the default; accuracy with "
                  "--format tex)");
  options.add("--protocol", "NAME", flags->protocols, "Show only this protocol (default: all)");
  options.add(
      "--only", "PATTERN", flags->only,
      "Show only the cells whose SEQUENCE/NAME, SEQUENCE or NAME matches this pattern (* and ?)");
  add_look_options(options, *flags);
  options.add_flag("--with-published", flags->with_published,
                   "Also show published rows for the same frames of the same sequence");
  options.set_footer(
      "Examples:\n"
      "  raymoval table out/street\n"
      "  raymoval table out/street --what losses,intervals\n"
      "  raymoval table out/street --protocol dynamicmap\n"
      "  raymoval table out/street --only 'street/raymoval*' --rates PR,RR,F1 --sort F1\n"
      "  raymoval table out/kitti --with-published --format tex\n"
      "  raymoval table out/street --format tex --what times,stages\n"
      "  raymoval table out/kitti --layout paper --decimals 3 --format tex");
  return {options.name(), [flags] { return show(*flags); }};
}

}  // namespace raymoval
