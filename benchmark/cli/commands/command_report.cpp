// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/report/page.h"
#include "benchmark/result/checks/result_sets.h"
#include "benchmark/run/folder/kept_run.h"
#include "benchmark/tables/published_columns.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/terminal_colour.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct ReportFlags {
  std::string run, data, points;
  OutputFlag output;
  bool no_points = false, simulate = false;
  WorkFlags work;
};

/// Whether the page gets a 3-D view.
/// @throws UsageError if an option of the 3-D view is given and the page has none
bool with_points(const ReportFlags& flags) {
  const std::string given = !flags.data.empty()     ? "--data " + flags.data
                            : !flags.points.empty() ? "--points " + flags.points
                            : flags.simulate        ? "--simulate"
                                                    : "";
  if (!given.empty() && flags.no_points) {
    throw UsageError(given +
                     ": is for the 3-D view, which --no-points leaves out. Drop one of them.");
  }
  return !flags.no_points;
}

/// The papers' rows. If they are not shipped, the report is made without them.
std::vector<OutsideColumn> papers(const RunResults& results) {
  auto columns = if_whole(published_columns).value_or(std::vector<OutsideColumn>());
  set_beside(columns, results);
  return columns;
}

std::string size_text(std::size_t bytes) {
  return fixed_text(static_cast<double>(bytes) / (1024.0 * 1024.0), 2) + " MiB";
}

ExitCode report(const ReportFlags& flags) {
  if (flags.run.empty()) throw UsageError("RUN is missing: expected `raymoval report RUN`.");
  if (!flags.output.path.empty()) {
    const std::string extension = std::filesystem::path(flags.output.path).extension().string();
    if (extension != ".html" && extension != ".htm") {
      throw UsageError("-o " + flags.output.path +
                       ": a report is a page, expected a name that ends in .html. A browser prints "
                       "it to PDF.");
    }
    flags.output.check();
  }
  const int threads = flags.work.thread_count();
  Progress progress(flags.work.style());
  PageRequest request;
  if (!flags.points.empty()) {
    request.points = static_cast<std::size_t>(parse_whole("--points", flags.points, 1000, 20000000,
                                                          "a whole number", ", such as 300000"));
  }
  request.with_points = with_points(flags);
  const std::filesystem::path results = find_results(flags.run);
  const KeptRun run(flags.run, flags.data, flags.simulate);
  request.run = &run;
  request.published = papers(run.results());
  request.methods = &program_methods();
  request.points_needed = !flags.data.empty() || flags.simulate;  // The user asks for them.
  request.threads = threads;
  request.progress = &progress;
  request.cancel = &interrupt_flag();
  const Page page = make_page(request);
  progress.end();
  for (const std::string& warning : page.warnings) {
    print_error("raymoval: left out of the 3-D view: " + warning);
  }
  const std::filesystem::path output = flags.output.path.empty()
                                           ? results.parent_path() / "report.html"
                                           : output_target(flags.output.path);
  write_atomically(output, page.html);
  print("wrote " + output.string() + " (" + size_text(page.html.size()) + ")\n");
  return ExitCode::kDone;
}

}  // namespace

Command add_report_command(CommandParser& program) {
  auto flags = std::make_shared<ReportFlags>();
  CommandOptions options =
      program.add_command("report", "Writes a report of a run: one HTML page with a 3-D view");
  options.add("run", "RUN", flags->run, "The run folder");
  flags->output.add_to(options, "-o,--output",
                       "The page to write (default: RUN/report.html, which is replaced)");
  options.add("--data", "PATH", flags->data, "Folder of the data, if it was moved since the run");
  options.add("--points", "N", flags->points,
              "Put at most N points into the page (default: 1000000)");
  options.add_flag("--simulate", flags->simulate,
                   "Simulate scenes of the run that are not in the cache; they may be large");
  options.add_flag("--no-points", flags->no_points, "Leave the 3-D view out");
  flags->work.add_to(options);
  options.set_footer(
      "The page is one file that opens from disk and needs no network. Its 3-D view shows the "
      "points of\n"
      "each cell that was run with --keep-removals.\n"
      "Examples:\n"
      "  raymoval run --sequence town --method raymoval --keep-removals --out out/town\n"
      "  raymoval report out/town\n"
      "  raymoval report out/town -o town.html --points 300000");
  return {options.name(), [flags] { return report(*flags); }};
}

}  // namespace raymoval
