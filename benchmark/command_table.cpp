// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/column_tables.h"
#include "benchmark/commands.h"
#include "benchmark/published_columns.h"
#include "benchmark/result_sets.h"
#include "benchmark/sealed_json.h"
#include "benchmark/tables.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct TableFlags {
  std::string run, format = "md";
  std::vector<std::string> protocols;
  bool with_published = false;
  bool columns = false;
};

ExitCode show(const TableFlags& flags) {
  const std::vector<std::string> formats = {"md", "csv", "tex", "json"};
  if (flags.run.empty()) throw UsageError("which run? Expected `raymoval table RUN`.");
  if (std::find(formats.begin(), formats.end(), flags.format) == formats.end()) {
    throw UsageError("--format " + flags.format + " is unknown." +
                     suggestion(flags.format, formats));
  }
  const bool plain = flags.format == "md" || flags.format == "tex";
  if (flags.with_published && !plain) {
    throw UsageError("--with-published goes with --format md or tex.");
  }
  if (flags.columns && (!plain || flags.with_published)) {
    throw UsageError("--columns goes with --format md or tex, and without --with-published.");
  }
  const std::filesystem::path file = find_results(flags.run);
  const nlohmann::ordered_json json = read_sealed(file);
  if (flags.format == "json" && !flags.protocols.empty()) {
    throw UsageError("--protocol goes with --format md, csv or tex.");
  }
  RunResults results = parse_results(json, file.string());
  choose_protocols(results, flags.protocols);
  std::vector<OutsideColumn> outside;
  if (flags.with_published) outside = published_columns();
  if (flags.format == "json") {
    print(json_text(json));
  } else if (flags.format == "csv") {
    print(results_csv(results));
  } else {
    const auto tables = flags.columns ? full_column_tables(results) : make_tables(results, outside);
    print(flags.format == "md" ? tables_markdown(results, tables) : tables_latex(tables));
  }
  return ExitCode::kDone;
}

}  // namespace

Command add_table_command(CLI::App& program) {
  auto flags = std::make_shared<TableFlags>();
  CLI::App* app = program.add_subcommand("table", "Prints the tables of a run");
  app->allow_extras();
  app->add_option("run", flags->run, "Run folder")->type_name("RUN");
  app->add_option("--format", flags->format, "md (default), csv, tex or json")->type_name("FORMAT");
  app->add_option("--protocol", flags->protocols, "Only what this protocol says (default: all)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app->add_flag("--columns", flags->columns,
                "Instead of the usual tables: points by class, range and height, and intervals");
  app->add_flag("--with-published", flags->with_published, "Set papers' rows beside the run's");
  app->footer(
      "Examples:\n"
      "  raymoval table out/street\n"
      "  raymoval table out/street --columns\n"
      "  raymoval table out/street --protocol dynamicmap\n"
      "  raymoval table out/kitti --with-published --format tex");
  return {app, [flags] { return show(*flags); }};
}

}  // namespace raymoval
