// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <optional>

#include "benchmark/clean/clean_checks.h"
#include "benchmark/clean/clean_outputs.h"
#include "benchmark/clean/clean_process.h"
#include "benchmark/cli/command.h"
#include "benchmark/cli/suite_flags.h"
#include "benchmark/process/mask_spool.h"
#include "benchmark/process/method_run.h"
#include "benchmark/result/removals/removal_files.h"
#include "benchmark/suite/amounts.h"
#include "core/files/file_writer.h"
#include "core/process/proc_files.h"
#include "core/process/process_family.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "datasets/reading/loaded_data.h"

namespace raymoval {
namespace {

struct CleanFlags {
  std::string path, output, dynamic, labels, voxel, memory_limit;
  std::string method = "raymoval_plus:offline";
  std::vector<std::string> settings;
  SequenceFlags reading;
  bool overwrite = false;
  bool force = false;
  bool in_process = false;
  WorkFlags work;
};

/// What `--range` keeps of the points of a scan.
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

ConfiguredMethod configured(const CleanFlags& flags) {
  Suite suite;
  add_method(suite, flags.method, "", program_methods());
  std::vector<Setting> settings;
  for (const std::string& text : flags.settings) settings.push_back(parse_setting(text));
  apply_settings(suite, settings);
  warn_of_settings_without_effect(suite);
  return suite.methods.front().method;
}

void find_removals(const CleanFlags& flags, const ConfiguredMethod& method,
                   const Sequence& sequence, const TimedSource& scans, MaskSpool& masks,
                   Progress& progress) {
  const auto remover = make_remover(method, sequence);
  RunContext context;
  context.threads = flags.work.thread_count();
  context.progress = &progress;
  context.cancel = &interrupt_flag();
  remover->run(scans, masks, context);
  masks.check_complete();
}

void write_outputs(const ScanSource& scans, const MaskSpool& masks, RangeCut& range,
                   CleanOutputs& outputs, Progress& progress) {
  progress.begin("writing the map", scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (interrupt_flag()) throw Cancelled();
    const Scan scan = scans.load(i);
    outputs.add(scan, range.cut(scan, masks.get(i)));
    progress.advance();
  }
  if (range.left_out == masks.point_count()) {
    throw DataError("no point lies within --range " + number_text(range.kept->min) + ":" +
                    number_text(range.kept->max) +
                    " (metres from the sensor), so nothing was written. Choose another.");
  }
  outputs.commit();
  progress.end();
}

CleanPaths checked_paths(const CleanFlags& flags) {
  if (flags.path.empty()) throw UsageError("clean what? Expected `raymoval clean PATH -o FILE`.");
  if (flags.output.empty()) throw UsageError("-o FILE is missing: name the cleaned map's file.");
  check_not_both(flags.path);
  CleanPaths paths{output_target(flags.output), output_target(flags.dynamic), flags.labels,
                   flags.overwrite};
  check_paths(paths);
  return paths;
}

Sequence opened(const CleanFlags& flags, const CleanPaths& paths, const ConfiguredMethod& method,
                Progress& progress) {
  Sequence sequence = open_sequence(flags.path, flags.reading.options(),
                                    {flags.work.thread_count(), &progress, &interrupt_flag()});
  if (sequence.scans->size() == 0) {
    throw DataError("sequence '" + sequence.name + "' has no scan in the chosen frames (" +
                    sequence.frames + ").");
  }
  check_apart_from(sequence, paths);
  if (method.entry->needs_truth && !sequence.labels) {
    throw UsageError("sequence '" + sequence.name + "' has no labels, and " + method.entry->name +
                     " answers from them; choose another --method.");
  }
  return sequence;
}

/// The words of this command with the option that makes the child do the work itself.
std::vector<std::string> arguments_of_child() {
  std::vector<std::string> arguments = program_arguments();
  const auto command = std::find(arguments.begin(), arguments.end(), "clean");
  arguments.insert(command == arguments.end() ? command : command + 1, "--in-process");
  return arguments;
}

/// What was done, a line each.
std::string cleaning_summary(const CleanFlags& flags, const ConfiguredMethod& method,
                             const Sequence& sequence, const MaskSpool& masks,
                             const RangeCut& range, const CleanOutputs& outputs) {
  std::string text = method.full_name() + " removed " + grouped_text(masks.removed_count()) +
                     " of " + counted_text(masks.point_count(), "point") + " in " +
                     counted_text(sequence.scans->size(), "scan") + "; " + flags.output + " has " +
                     counted_text(outputs.map_points(), "point") + ".\n";
  if (range.kept) {
    text += counted_text(range.left_out, "point") + " beyond --range " + flags.reading.range +
            " are in no output.\n";
  }
  for (const std::string& line : left_out_lines(sequence)) text += line + ".\n";
  return text;
}

ExitCode clean_here(const CleanFlags& flags, const CleanPaths& paths, Progress& progress) {
  const double voxel = flags.voxel.empty() ? 0.0 : parse_positive("--voxel", flags.voxel);
  const ConfiguredMethod method = configured(flags);
  const Sequence sequence = opened(flags, paths, method, progress);
  const std::string turned = up_line(sequence.up());
  if (!turned.empty()) progress.say(sequence.name + ": " + turned);
  check_data(sequence, flags.path, flags.force, progress, interrupt_flag());
  progress.set_context(method.full_name() + " on " + sequence.name);
  const MapPrecision precision = map_precision(*sequence.scans);
  CleanOutputs outputs(paths, voxel, precision);
  // A scan that is another when the map is written than when it was judged is an error.
  const WatchedSequence data = watched(sequence);
  const LocalFrameSource local(*data.sequence.scans, sequence.method_frame());
  const TimedSource scans(local);
  MaskSpool masks(method.full_name(), scans, paths.map);
  find_removals(flags, method, data.sequence, scans, masks, progress);
  RangeCut range{flags.reading.options().range_m};
  write_outputs(*data.sequence.scans, masks, range, outputs, progress);
  if (precision.coordinates == Coordinates::kDouble) {
    print("The map lies more than 8 km from the world's origin: its coordinates are float64.\n");
  }
  if (!is_control(method.entry->name)) {
    check_removed(masks.removed_count(), masks.point_count(), flags.path);
  }
  print(cleaning_summary(flags, method, sequence, masks, range, outputs));
  return ExitCode::kDone;
}

ExitCode clean(const CleanFlags& flags) {
  const CleanPaths paths = checked_paths(flags);
  const double limit = flags.memory_limit.empty()
                           ? usual_memory_limit_mib()
                           : parse_memory_mib("--memory-limit", flags.memory_limit);
  if (!flags.in_process) {
    return clean_apart(arguments_of_child(), paths, limit, interrupt_flag());
  }
  // As the child of `clean_apart` it takes what it has started with it when that ends.
  if (is_family_head()) end_family_with_parent();
  Progress progress(flags.work.style());
  try {
    return clean_here(flags, paths, progress);
  } catch (...) {
    progress.end();  // The message gets a line of its own.
    throw;
  }
}

}  // namespace

Command add_clean_command(CommandParser& program) {
  auto flags = std::make_shared<CleanFlags>();
  CommandOptions options = program.add_command("clean", "Writes a map without moving objects");
  SequenceFlags::add_place_to(options, flags->path);
  options.add("-o,--output", "FILE", flags->output,
              "The cleaned map in the world frame: a .pcd, .ply or .bin file");
  options.add("--dynamic", "FILE", flags->dynamic, "Also write what was removed, as a map");
  options.add(
      "--labels", "DIR", flags->labels,
      "Also write a label file for each scan into this folder (251 = removed, 9 = kept, 0 = left "
      "out)");
  options.add("--voxel", "METRES", flags->voxel, "Keep one point in each cell of this size");
  options.add("--method", "NAME", flags->method,
              "The method (default: raymoval_plus:offline, which is the best)");
  options.add("--set", "SETTING", flags->settings, "A parameter: METHOD.key=value");
  flags->reading.add_to(options);
  options.set_sentence("--range",
                       "Distance from the sensor in metres. Points outside it are in no output, "
                       "but the method sees them");
  options.add(
      "--memory-limit", "SIZE", flags->memory_limit,
      "The memory it may use, in MiB or with a unit such as 2GB (default: nine tenths of the "
      "machine's)");
  options.add_flag("--force", flags->force,
                   "Clean even if the data has mistakes that make the map wrong");
  options.add_flag("--in-process", flags->in_process,
                   "Work in this process, for a debugger; there is then no limit on memory");
  options.add_flag("--overwrite", flags->overwrite, "Replace outputs that exist already");
  flags->work.add_to(options);
  options.set_footer(
      "Examples:\n"
      "  raymoval clean data/05 -o static.pcd\n"
      "  raymoval clean data/05 -o static.ply --dynamic removed.ply --voxel 0.1 "
      "--method raymoval:online\n"
      "  raymoval clean data/05 -o near.pcd --range 2:40 --drop-ego auto\n"
      "The data is checked first, as `raymoval inspect` does. Mistakes that make the map wrong "
      "are\nrefused (see `raymoval inspect --list`) unless --force is given. Points on the "
      "sensor's vehicle (--drop-ego)\nand missing returns (NaN or at the origin) are in no output "
      "and have label 0.\n"
      "The memory does not grow with the number of scans. Without --voxel every point is kept. The "
      "outputs\nappear when all is done; until then they are files *.part in the same folder.");
  return {options.name(), [flags] { return clean(*flags); }};
}

}  // namespace raymoval
