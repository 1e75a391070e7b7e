// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/process/command_process.h"
#include "benchmark/result/record_fields.h"
#include "core/process/process_family.h"
#include "core/text.h"
#include "datasets/inspection/inspect.h"
#include "datasets/open_sequence.h"

namespace raymoval {

static const char* severity_name(Severity severity) {
  return severity == Severity::kNote ? "note" : "finding";
}

static void describe(RecordWriter& writer, const Finding& finding) {
  writer.field("check", finding.check);
  writer.field("severity", severity_name(finding.severity));
  writer.field("where", finding.where);
  writer.field("what", finding.what);
  writer.field("expected", finding.expected);
  writer.field("remedy", finding.remedy);
}

static void describe(RecordWriter& writer, const InspectionReport& report) {
  writer.field("sequence", report.sequence);
  writer.field("layout", report.layout);
  writer.field("scans", report.scans);
  writer.field("scans_read", report.scans_read);
  writer.field("sensor", report.sensor);
  writer.field("pose_fit", report.pose_fit);
  writer.field("notes", report.notes);
  writer.field("findings", report.findings);
  writer.field("measures", report.measures);
}

namespace {

struct InspectFlags {
  std::string path;
  SequenceFlags reading;
  bool json = false, list = false;
  PosesFlag poses;
  ProcessFlags process;
  WorkFlags work;
};

std::string finding_line(const Finding& finding) {
  return std::string(severity_name(finding.severity)) + " " + finding.sentence() + "\n";
}

std::string report_text(const InspectionReport& report) {
  std::string text;
  for (const std::string& note : report.notes) text += note + "\n";
  for (const Finding& finding : report.findings) text += finding_line(finding);
  const auto notes = static_cast<std::size_t>(
      std::count_if(report.findings.begin(), report.findings.end(),
                    [](const Finding& f) { return f.severity == Severity::kNote; }));
  const std::size_t findings = report.findings.size() - notes;
  if (!report.sensor.empty()) text += report.sequence + ": sensor " + report.sensor + ".\n";
  if (!report.pose_fit.empty()) text += report.sequence + ": " + report.pose_fit + ".\n";
  text += report.sequence + ": " + counted_text(findings, "finding");
  if (notes > 0) text += ", " + counted_text(notes, "note");
  if (report.scans == 0) return text + "; the sequence cannot be opened.\n";
  return text + " (" + report.layout + ", " + grouped_text(report.scans_read) + " of " +
         counted_text(report.scans, "scan") + " read).\n";
}

const char* consequence_text(Consequence consequence) {
  switch (consequence) {
    case Consequence::kRefused:
      return " (clean refuses it)";
    case Consequence::kWarned:
      return " (clean warns)";
    case Consequence::kUnused:
      return " (clean ignores it)";
  }
  throw InternalError("unknown consequence of a check");
}

std::string check_list() {
  std::string text;
  for (const InspectionCheck& check : inspection_checks()) {
    text += check.name + ": " + check.finds + "." + consequence_text(check.consequence) + "\n";
    if (!check.remedy.empty()) text += "    " + check.remedy + "\n";
  }
  return text;
}

/// Untrusted data may make the child take much memory, or crash it.
ExitCode inspect_in_child(double limit_mib) {
  try {
    return run_command_in_child(
        ProcessFlags::child_arguments("inspect"),
        {.doing = "inspecting", .less_memory = " Choose fewer --frames, or raise the limit."},
        limit_mib, interrupt_flag());
  } catch (const MethodError& error) {
    throw InternalError(error.what());
  }
}

ExitCode inspect_command(const InspectFlags& flags) {
  if (flags.list) {
    print(check_list());
    return ExitCode::kDone;
  }
  if (flags.path.empty()) {
    throw UsageError("PATH is missing: name a sequence folder, ROOT:05, or a scene.");
  }
  check_not_both(flags.path);
  flags.poses.file.check();
  const double limit = flags.process.memory_limit_mib();
  if (!flags.process.in_process) return inspect_in_child(limit);
  if (is_family_head()) end_family_with_parent();
  Progress progress(flags.work.style());
  const InspectionReport report =
      inspect_path(flags.path, flags.reading.options(),
                   {flags.work.thread_count(), &progress, &interrupt_flag()},
                   [&](const Sequence& sequence) { flags.poses.write(sequence); });
  print(flags.json ? json_text(to_json(report)) : report_text(report));
  return report.has_findings() ? ExitCode::kWorse : ExitCode::kDone;
}

}  // namespace

Command add_inspect_command(CommandParser& program) {
  auto flags = std::make_shared<InspectFlags>();
  CommandOptions options =
      program.add_command("inspect", "Finds mistakes in the data of a sequence");
  SequenceFlags::add_place_to(options, flags->path);
  flags->reading.add_to(options);
  options.add_flag("--json", flags->json, "Print the findings and the measured numbers as JSON");
  options.add_flag("--list", flags->list, "List the checks, and the remedy for each finding");
  flags->poses.add_to(options, true);
  flags->process.add_to(options);
  flags->work.add_to(options);
  options.set_footer(
      "Each finding is one line: the mistake, its place, what was expected, and the remedy. Then "
      "follow\n"
      "the named and the estimated sensor, and how far apart the poses leave surfaces of "
      "overlapping scans.\n"
      "About thirty scans are read, two more every few metres to check the poses, and the poses, "
      "times\n"
      "and sizes of all scans.\n"
      "Exit codes: 0 nothing found, 1 findings, 2 unreadable data or wrong usage.\n"
      "Examples:\n"
      "  raymoval inspect data/05\n"
      "  raymoval inspect KITTI:kitti-05 --json\n"
      "  raymoval inspect scans/ --poses odometry.txt\n"
      "  raymoval inspect scans/ --poses refine:odometry.txt --write-poses refined.txt\n"
      "  raymoval inspect --list");
  return {options.name(), [flags] { return inspect_command(*flags); }};
}

}  // namespace raymoval
