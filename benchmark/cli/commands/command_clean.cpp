// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "benchmark/clean/clean_outputs.h"
#include "benchmark/clean/clean_process.h"
#include "benchmark/clean/clean_summary.h"
#include "benchmark/cli/command.h"
#include "benchmark/cli/suite_flags.h"
#include "benchmark/process/method_run.h"
#include "benchmark/result/removals/edits.h"
#include "benchmark/result/removals/removal_files.h"
#include "benchmark/suite/amounts.h"
#include "core/files/file_writer.h"
#include "core/process/process_family.h"
#include "core/terminal_colour.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"

namespace raymoval {
namespace {

struct CleanFlags {
  std::string path, output, dynamic, labels, scans, page, picture;
  std::string voxel, caution, edits;
  std::string method;
  std::vector<std::string> settings;
  SequenceFlags reading;
  bool confidence = false;
  bool overwrite = false;
  bool force = false;
  PosesFlag poses;
  ProcessFlags process;
  WorkFlags work;
};

/// Cuts the points of a scan by `--range`.
struct RangeCut {
  std::optional<RangeLimits> kept;
  std::uint64_t left_out = 0;

  /// `mask` with `kLeftOutMask` for the points beyond.
  Mask cut(const Scan& scan, Mask mask) {
    if (!kept) return mask;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (kept->contains(scan.points[i].cast<double>().norm())) continue;
      mask[i] = kLeftOutMask;
      ++left_out;
    }
    return mask;
  }
};

/// Facts of the summary that neither the outputs nor the method report.
struct CleaningFacts {
  const CleanPaths& paths;
  RangeCut range;
  RangeShares shares = {};
  InspectionReport report = {};
  double seconds = 0.0;
  std::string corrections = {};  ///< A sentence on the edits; empty without --edits.
};

constexpr const char* kDefaultMethod = "raymoval_plus:offline";

ConfiguredMethod configured(const CleanFlags& flags) {
  Suite suite;
  const std::string& name = flags.method.empty() ? kDefaultMethod : flags.method;
  add_method(suite, name, "", program_methods());
  std::vector<Setting> settings;
  for (const std::string& text : flags.settings) settings.push_back(parse_setting(text));
  apply_settings(suite, settings);
  warn_of_settings_without_effect(suite);
  ConfiguredMethod method = suite.methods.front().method;
  const char* needs = flags.confidence ? "--confidence" : "--caution";
  if ((flags.confidence || !flags.caution.empty()) && method.entry->confidence.empty()) {
    std::vector<std::string> names;
    for (const auto& entry : program_methods().entries()) {
      if (!entry->confidence.empty()) names.push_back(entry->name);
    }
    throw UsageError(std::string(needs) + ": " + method.entry->name +
                     " has no confidence. Choose another --method (" + join(names) +
                     "), or leave it out.");
  }
  return method;
}

/// Edits hold the answer of a method, so no method runs. @throws UsageError
void check_edits(const CleanFlags& flags) {
  if (flags.edits.empty()) return;
  const std::pair<const char*, bool> others[] = {{"--method", !flags.method.empty()},
                                                 {"--set", !flags.settings.empty()},
                                                 {"--caution", !flags.caution.empty()},
                                                 {"--confidence", flags.confidence}};
  for (const auto& [option, given] : others) {
    if (!given) continue;
    throw UsageError(std::string(option) +
                     " has no effect with --edits, which holds the answer of the method that was "
                     "reviewed. Leave one of them out.");
  }
}

/// The number of --caution in confidence steps. @throws UsageError
int caution_steps(const std::string& text) {
  const auto caution = parse_number<double>(text);
  if (!caution || !(*caution >= 0.0 && *caution <= 1.0)) {
    throw UsageError("--caution " + text +
                     ": expected a number from 0 (remove whatever may move) "
                     "to 1 (remove only what is certain).");
  }
  return static_cast<int>(std::ceil(*caution * kConfidenceSteps - 1e-9));
}

/// Masks of the points with at least this confidence. Points with the method's lowest confidence,
/// for which it has no evidence, are never removed.
MaskStore cautious_masks(const MethodAnswer& answer, const ConfiguredMethod& method, int steps) {
  const float lowest = method.entry->confidence.curve.front().confidence;
  const int least = std::max<int>(steps, confidence_steps(lowest) + 1);
  MaskStore masks(answer.masks.size());
  for (std::size_t i = 0; i < masks.size(); ++i) {
    Mask mask;
    for (const char byte : answer.confidence.steps.get(i)) {
      mask.push_back(static_cast<std::uint8_t>(byte) >= least ? 1 : 0);
    }
    masks.set(i, mask);
  }
  return masks;
}

/// The points that the method removes, in unnamed files beside the first output.
MethodAnswer find_removals(const CleanFlags& flags, const ConfiguredMethod& method,
                           const Sequence& sequence, const CleanPaths& paths, Progress& progress) {
  const MethodRequest request{method.full_name(), method};
  MethodTask task{&sequence, &request};
  task.options.threads = flags.work.thread_count();
  task.options.with_confidence = flags.confidence || !flags.caution.empty() ||
                                 (!flags.page.empty() && !method.entry->confidence.empty());
  task.progress = &progress;
  task.cancel = &interrupt_flag();
  task.spool_beside = paths.all().front().path;
  MethodAnswer answer = run_remover(*make_remover(method, sequence), task);
  if (!flags.caution.empty()) {
    answer.masks = cautious_masks(answer, method, caution_steps(flags.caution));
  }
  return answer;
}

/// The removals of a reviewed answer.
MethodAnswer edited_removals(const CleanFlags& flags, const Edits& edits, const ScanSource& scans,
                             CleaningFacts& facts, Progress& progress) {
  progress.begin("applying the edits", scans.size());
  EditedMasks edited = apply_edits(edits, scans, flags.edits, flags.force, [&progress] {
    progress.advance();
    if (interrupt_flag()) throw Cancelled();
  });
  progress.end();
  if (edited.changed_scans > 0) {
    print_warning("continuing because of --force, although " +
                  counted_text(edited.changed_scans, "scan") + " changed since the review.");
  }
  facts.corrections = flags.edits + ": " + counted_text(edited.kept, "removed point") +
                      " kept and " + counted_text(edited.removed, "kept point") +
                      " removed by hand.\n";
  MethodAnswer answer;
  answer.masks = std::move(edited.masks);
  return answer;
}

void write_outputs(const ScanSource& scans, const MethodAnswer& answer, CleaningFacts& facts,
                   CleanOutputs& outputs, Progress& progress) {
  RangeCut& range = facts.range;
  progress.begin("writing the outputs", scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (interrupt_flag()) throw Cancelled();
    const Scan scan = scans.load(i);
    const Mask mask = range.cut(scan, answer.masks.get(i));
    facts.shares.add(scan, mask);
    outputs.add(scan, mask, answer.confidence.empty() ? "" : answer.confidence.steps.get(i));
    progress.advance();
  }
  if (range.left_out == answer.masks.point_count()) {
    throw DataError("no point lies within --range " + number_text(range.kept->min) + ":" +
                    number_text(range.kept->max) +
                    " (metres from the sensor), so nothing was written. Choose another.");
  }
  outputs.commit();
  progress.end();
}

CleanPaths checked_paths(const CleanFlags& flags) {
  if (flags.path.empty())
    throw UsageError("PATH is missing: expected `raymoval clean PATH -o FILE`.");
  check_not_both(flags.path);
  CleanPaths paths;
  paths.map = output_target(flags.output);
  paths.removed = output_target(flags.dynamic);
  paths.labels = flags.labels;
  paths.scans = flags.scans;
  paths.page = output_target(flags.page);
  paths.picture = output_target(flags.picture);
  paths.overwrite = flags.overwrite;
  if (paths.all().empty()) {
    throw UsageError("-o FILE is missing: name the cleaned map's file, or another output.");
  }
  check_paths(paths);
  OutputFlag poses = flags.poses.file;
  poses.overwrite = flags.overwrite;
  poses.check();
  return paths;
}

CleanWriting writing_of(const CleanFlags& flags, const ConfiguredMethod& method) {
  CleanWriting writing;
  if (!flags.voxel.empty()) writing.voxel_size = parse_positive("--voxel", flags.voxel);
  writing.method = method.full_name();
  if (!flags.caution.empty()) writing.method += ", caution " + flags.caution;
  writing.confidence = flags.confidence;
  return writing;
}

Sequence opened(const CleanFlags& flags, const CleanPaths& paths, const ConfiguredMethod& method,
                Progress& progress) {
  Sequence sequence = open_sequence(flags.path, flags.reading.options(),
                                    {flags.work.thread_count(), &progress, &interrupt_flag()});
  if (sequence.scans->size() == 0) {
    throw DataError("sequence '" + sequence.name + "' has no scan in the chosen frames (" +
                    sequence.frames + ").");
  }
  std::vector<std::filesystem::path> inputs = flags.reading.files();
  if (!flags.edits.empty()) inputs.emplace_back(flags.edits);
  check_apart_from(sequence, paths, inputs);
  flags.poses.write(sequence);
  if (flags.edits.empty() && method.entry->needs_truth && !sequence.labels) {
    throw UsageError("sequence '" + sequence.name + "' has no labels, and " + method.entry->name +
                     " needs them; choose another --method.");
  }
  return sequence;
}

/// The arguments for reading the sequence, so that its cleaned scans are read in the same way.
/// @param own_poses leaves out arguments on poses
std::string reading_arguments(bool own_poses) {
  constexpr std::array kReading = {"--sensor", "--up",           "--label-rule",
                                   "--points", "--point-layout", "--point-time-unit",
                                   "--deskew", "--sensor-origin"};
  constexpr std::array kPoses = {"--frames",      "--poses",   "--T-sensor",
                                 "--time-offset", "--max-gap", "--pose-format"};
  const auto is_one = [](const auto& names, const std::string& word) {
    return std::find(names.begin(), names.end(), word.substr(0, word.find('='))) != names.end();
  };
  std::string text;
  const std::vector<std::string>& words = program_arguments();
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!is_one(kReading, words[i]) && (own_poses || !is_one(kPoses, words[i]))) continue;
    text += ' ' + words[i];
    const bool takes_next = words[i] != "--deskew" && words[i].find('=') == std::string::npos;
    if (takes_next && i + 1 < words.size()) text += ' ' + words[++i];
  }
  return text;
}

/// A line for each written output.
std::string outputs_summary(const CleanPaths& paths, const CleanOutputs& outputs) {
  std::string text;
  for (const OutputPath& output : paths.all()) {
    if (output.kind != OutputKind::kScans) continue;
    text += "The cleaned scans open with: raymoval inspect " + output.path.string() +
            reading_arguments(outputs.has_own_poses()) + "\n";
  }
  for (const std::string& line : outputs.results()) text += line + '\n';
  return text;
}

/// The lines of the summary.
std::string cleaning_summary(const CleanFlags& flags, const std::string& method,
                             const Sequence& sequence, const MaskStore& masks,
                             const CleaningFacts& facts, const CleanOutputs& outputs) {
  const CleanPaths& paths = facts.paths;
  std::string text = method + " removed " + grouped_text(masks.removed_count()) + " of " +
                     counted_text(masks.point_count(), "point") + " in " +
                     counted_text(sequence.scans->size(), "scan");
  if (const auto points = outputs.map_points()) {
    text += "; " + paths.first_map().string() + " has " + counted_text(*points, "point");
  }
  text += ".\n" + facts.corrections + facts.shares.table();
  if (facts.range.kept) {
    text += counted_text(facts.range.left_out, "point") + " beyond --range " +
            flags.reading.text("range") + " are in no output.\n";
  }
  const std::string empty = empty_scans_line(sequence);
  if (!empty.empty()) print_warning(sequence.name + ": " + empty + ".");
  for (const std::string& line : left_out_lines(sequence)) text += line + ".\n";
  for (const std::string& line : sequence.notes) text += line + '\n';
  if (!facts.report.pose_fit.empty()) text += sequence.name + ": " + facts.report.pose_fit + ".\n";
  text += outputs_summary(paths, outputs);
  text += "It took " + fixed_text(facts.seconds, 1) + " s.\nIf the map does not look right:\n";
  for (const std::string& line :
       remedies(masks.removed_count(), masks.point_count(), flags.path, method,
                facts.report.findings, !paths.page.empty() || !paths.picture.empty())) {
    text += "  - " + line + '\n';
  }
  return text;
}

ExitCode clean_in_process(const CleanFlags& flags, const CleanPaths& paths, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const ConfiguredMethod method = configured(flags);
  CleanWriting writing = writing_of(flags, method);
  std::optional<Edits> edits;
  if (!flags.edits.empty()) {
    edits = read_edits(flags.edits);
    writing.method = edits->method;
    const std::string mark = ", corrected";
    if (!writing.method.ends_with(mark)) writing.method += mark;
  }
  const Sequence sequence = opened(flags, paths, method, progress);
  const std::string turned = up_line(sequence.up());
  if (!turned.empty()) progress.say(sequence.name + ": " + turned);
  for (const std::string& line : sequence.losses) print_warning(line);
  CleaningFacts facts{paths, RangeCut{flags.reading.options().range_m}};
  facts.report = check_data(sequence, flags.path, flags.force,
                            {flags.work.thread_count(), &progress, &interrupt_flag()});
  progress.set_context(writing.method + " on " + sequence.name);
  CleanOutputs outputs(paths, writing, sequence, progress, interrupt_flag());
  for (const std::string& note : outputs.notes()) print_error("raymoval: " + note);
  const MethodAnswer answer = edits
                                  ? edited_removals(flags, *edits, *sequence.scans, facts, progress)
                                  : find_removals(flags, method, sequence, paths, progress);
  const MaskStore& masks = answer.masks;
  write_outputs(*sequence.scans, answer, facts, outputs, progress);
  facts.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!is_control(method.entry->name)) {
    check_removed(masks.removed_count(), masks.point_count(), flags.path);
  }
  print(cleaning_summary(flags, writing.method, sequence, masks, facts, outputs));
  return ExitCode::kDone;
}

ExitCode clean(const CleanFlags& flags) {
  const CleanPaths paths = checked_paths(flags);
  check_edits(flags);
  if (!flags.caution.empty()) caution_steps(flags.caution);
  const double limit = flags.process.memory_limit_mib();
  if (!flags.process.in_process) {
    return clean_in_child(ProcessFlags::child_arguments("clean"), paths, limit, interrupt_flag());
  }
  // As the child of `clean_in_child`, this process ends with its parent, and its own children with
  // it.
  if (is_family_head()) end_family_with_parent();
  Progress progress(flags.work.style());
  try {
    return clean_in_process(flags, paths, progress);
  } catch (...) {
    progress.end();  // The message gets a line of its own.
    throw;
  }
}

/// The options for the outputs.
void add_clean_outputs(CommandOptions& options, CleanFlags& flags) {
  options.add("-o,--output,--static", "FILE", flags.output,
              "The cleaned map in the world frame, with all fields of the scans: a file that ends "
              "in " +
                  join(written_extensions(), ", "));
  options.add("--dynamic", "FILE", flags.dynamic, "Also write the removed points as a map");
  options.add_flag("--confidence", flags.confidence,
                   "Add a field `confidence` to maps: the estimated probability, from 0 to 1, that "
                   "a point moves");
  options.add(
      "--labels", "DIR", flags.labels,
      "Also write a label file for each scan into this folder (251 = removed, 9 = kept, 0 = left "
      "out)");
  options.add("--scans", "DIR", flags.scans,
              "Also write each scan without its removed points, into a folder that opens like the "
              "sequence: in the format of the input, or as .pcd if that is a recording");
  options.add("--html", "FILE", flags.page,
              "Also write a page in which you can look at the map and correct it (.html)");
  options.add("--picture", "FILE", flags.picture, "Also write the map from above (.png)");
  flags.poses.add_to(options, false);
  options.add("--voxel", "METRES", flags.voxel,
              "Write one point per voxel of this size: the mean position and intensity, and the "
              "other fields of the point nearest to the centre of the voxel");
}

/// The options for reading and cleaning the sequence.
void add_clean_work(CommandOptions& options, CleanFlags& flags) {
  options.add("--method", "NAME", flags.method,
              "The method (default: raymoval_plus:offline, the most accurate)");
  options.add("--set", "SETTING", flags.settings, "A parameter: METHOD.key=value");
  options.add(
      "--caution", "SHARE", flags.caution,
      "Remove the points whose confidence is at least this, from 0 (whatever may move) to 1 "
      "(only what is certain), instead of those that the method chooses");
  options.add("--edits", "FILE", flags.edits,
              "Instead of a method's answer, write the corrected one that the page of --html "
              "exported");
  flags.reading.add_to(options);
  options.set_sentence("--range",
                       "Written distance from the sensor in metres. Points outside it are in no "
                       "output, but the method gets them");
  options.add_flag("--force", flags.force,
                   "Clean even if the data has mistakes that make the map wrong");
  flags.process.add_to(options);
  options.add_flag("--overwrite", flags.overwrite, "Replace outputs that exist already");
  flags.work.add_to(options);
}

}  // namespace

Command add_clean_command(CommandParser& program) {
  auto flags = std::make_shared<CleanFlags>();
  CommandOptions options = program.add_command("clean", "Writes a map without moving objects");
  SequenceFlags::add_place_to(options, flags->path);
  add_clean_outputs(options, *flags);
  add_clean_work(options, *flags);
  options.set_footer(
      "Examples:\n"
      "  raymoval clean data/05 -o static.pcd\n"
      "  raymoval clean data/05 -o static.ply --dynamic removed.ply --voxel 0.1 --method "
      "raymoval:online\n"
      "  raymoval clean data/05 -o near.pcd --range 2:40 --drop-ego auto\n"
      "  raymoval clean data/05 --scans cleaned --html map.html --picture map.png\n"
      "  raymoval clean data/05 --edits edits.json -o static.pcd\n"
      "  raymoval clean scans/ --poses estimate -o static.pcd --write-poses poses.txt\n"
      "The data is first checked as by `raymoval inspect`. Mistakes that make the map wrong are "
      "refused\n"
      "(see `raymoval inspect --list`) unless --force is given. Points on the ego vehicle "
      "(--drop-ego)\n"
      "and missing returns (NaN or at the origin) are in no output and have label 0.\n"
      "Memory use does not grow with the number of scans. Without --voxel every point is kept. "
      "Outputs\n"
      "get their names when all are complete; until then they are files *.part in the same "
      "folder.");
  return {options.name(), [flags] { return clean(*flags); }};
}

}  // namespace raymoval
