// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/cell.h"
#include "benchmark/clean_outputs.h"
#include "benchmark/commands.h"
#include "benchmark/mask_spool.h"
#include "core/parallel.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct CleanFlags {
  std::string path, output, dynamic, labels, voxel, threads;
  std::string method = "raymoval_plus:offline";
  std::vector<std::string> settings;
  SequenceFlags reading;
  bool overwrite = false;
  bool quiet = false;
};

ConfiguredMethod configured(const CleanFlags& flags) {
  Suite suite;
  add_method(suite, flags.method, "", program_methods());
  std::vector<Setting> settings;
  for (const std::string& text : flags.settings) settings.push_back(parse_setting(text));
  apply_settings(suite, settings);
  return suite.methods.front().method;
}

void find_removals(const CleanFlags& flags, const ConfiguredMethod& method,
                   const Sequence& sequence, const TimedSource& scans, MaskSpool& masks,
                   Progress& progress) {
  const int given = parse_threads(flags.threads);
  const auto remover = make_remover(method, sequence);
  RunContext context;
  context.threads = given > 0 ? given : hardware_threads();
  context.progress = &progress;
  context.cancel = &interrupt_flag();
  remover->run(scans, masks, context);
  masks.check_complete();
}

void write_outputs(const ScanSource& scans, const MaskSpool& masks, CleanOutputs& outputs,
                   Progress& progress) {
  progress.begin("writing the map", scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (interrupt_flag()) throw Cancelled();
    outputs.add(scans.load(i), masks.get(i));
    progress.advance();
  }
  outputs.commit();
  progress.end();
}

CleanPaths checked_paths(const CleanFlags& flags) {
  if (flags.path.empty()) throw UsageError("clean what? Expected `raymoval clean PATH -o FILE`.");
  if (flags.output.empty()) throw UsageError("-o FILE is missing: name the cleaned map's file.");
  check_not_both(flags.path);
  CleanPaths paths{flags.output, flags.dynamic, flags.labels, flags.overwrite};
  check_paths(paths);
  return paths;
}

Sequence opened(const CleanFlags& flags, const CleanPaths& paths, const ConfiguredMethod& method,
                Progress& progress) {
  const int given = parse_threads(flags.threads);
  Sequence sequence =
      open_sequence(flags.path, flags.reading.options(),
                    {given > 0 ? given : hardware_threads(), &progress, &interrupt_flag()});
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

ExitCode clean(const CleanFlags& flags, Progress& progress) {
  const CleanPaths paths = checked_paths(flags);
  const double voxel = flags.voxel.empty() ? 0.0 : parse_positive("--voxel", flags.voxel);
  const ConfiguredMethod method = configured(flags);
  const Sequence sequence = opened(flags, paths, method, progress);
  progress.set_context(method.full_name() + " on " + sequence.name);
  CleanOutputs outputs(paths, voxel);
  const TimedSource scans(*sequence.scans);
  MaskSpool masks(method.full_name(), scans, paths.map);
  find_removals(flags, method, sequence, scans, masks, progress);
  write_outputs(*sequence.scans, masks, outputs, progress);
  print(method.full_name() + " removed " + grouped_text(masks.removed_count()) + " of " +
        counted_text(masks.point_count(), "point") + " in " + counted_text(scans.size(), "scan") +
        "; " + flags.output + " has " + counted_text(outputs.map_points(), "point") + ".\n");
  return ExitCode::kDone;
}

ExitCode clean(const CleanFlags& flags) {
  Progress progress(flags.quiet ? ProgressStyle::kQuiet : progress_style_of_stderr());
  try {
    return clean(flags, progress);
  } catch (...) {
    progress.end();  // The message gets a line of its own.
    throw;
  }
}

}  // namespace

Command add_clean_command(CLI::App& program) {
  auto flags = std::make_shared<CleanFlags>();
  CLI::App* app = program.add_subcommand("clean", "Writes a map without moving objects");
  app->allow_extras();
  SequenceFlags::add_place_to(*app, flags->path);
  app->add_option("-o,--output", flags->output, "Cleaned map in the world frame: .pcd, .ply, .bin")
      ->type_name("FILE");
  app->add_option("--dynamic", flags->dynamic, "What was removed, as a map")->type_name("FILE");
  app->add_option("--labels", flags->labels, "Folder for a label file per scan (251 = removed)")
      ->type_name("DIR");
  app->add_option("--voxel", flags->voxel, "One point per cell of this size")->type_name("METRES");
  app->add_option("--method", flags->method,
                  "Method (default: raymoval_plus:offline, the best of them)")
      ->type_name("NAME");
  app->add_option("--set", flags->settings, "Parameter: METHOD.key=value")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  flags->reading.add_to(*app);
  app->add_option("--threads", flags->threads, "At most so many threads (default: all cores)")
      ->type_name("N");
  app->add_flag("--overwrite", flags->overwrite, "Replace outputs that are there already");
  app->add_flag("--quiet", flags->quiet, "No progress");
  app->footer(
      "Examples:\n"
      "  raymoval clean data/05 -o static.pcd\n"
      "  raymoval clean data/05 -o static.ply --dynamic removed.ply --voxel 0.1 "
      "--method raymoval:online\n"
      "Memory does not grow with the number of scans, and every point is kept without --voxel. "
      "Outputs\nappear when all is done; until then they stand in files *.part beside them.");
  return {app, [flags] { return clean(*flags); }};
}

}  // namespace raymoval
