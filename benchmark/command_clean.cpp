// SPDX-License-Identifier: MIT
#include <memory>

#include "benchmark/cell.h"
#include "benchmark/checked_sink.h"
#include "benchmark/commands.h"
#include "benchmark/map_cleaner.h"
#include "benchmark/removal_files.h"
#include "core/parallel.h"
#include "core/text.h"
#include "datasets/cloud_file.h"

namespace raymoval {
namespace {

struct CleanFlags {
  std::string path, output, dynamic, labels, voxel, threads;
  std::string method = "raymoval:offline";
  std::vector<std::string> settings;
  SequenceFlags reading;
  bool quiet = false;
};

/// Fails before the work if a cloud could not be written after it.
void check_cloud_path(const std::string& text) {
  const std::filesystem::path path(text);
  const std::vector<std::string>& known = cloud_extensions();
  if (std::find(known.begin(), known.end(), path.extension().string()) == known.end()) {
    throw UsageError(text + ": expected a file name that ends in " + join(known, ", ") + ".");
  }
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder)) {
    throw UsageError(text + ": there is no folder " + folder.string() + ". Make it first.");
  }
  if (std::filesystem::is_directory(path)) {
    throw UsageError(text + ": is a folder, expected a file name.");
  }
}

ConfiguredMethod configured(const CleanFlags& flags) {
  Suite suite;
  add_method(suite, flags.method, "", program_methods());
  std::vector<Setting> settings;
  for (const std::string& text : flags.settings) settings.push_back(parse_setting(text));
  apply_settings(suite, settings);
  return suite.methods.front().method;
}

MaskStore find_removals(const CleanFlags& flags, const ConfiguredMethod& method,
                        const Sequence& sequence, Progress& progress) {
  const int given = parse_threads(flags.threads);
  const auto remover = make_remover(method, sequence);
  const TimedSource scans(*sequence.scans);
  CheckedSink sink(method.full_name(), scans);
  RunContext context;
  context.threads = given > 0 ? given : hardware_threads();
  context.progress = &progress;
  context.cancel = &interrupt_flag();
  remover->run(scans, sink, context);
  return sink.finish();
}

void write_map(const std::string& path, const MapCollector& map) {
  if (!path.empty()) write_cloud(path, map.points(), map.reflectance());
}

void write_outputs(const CleanFlags& flags, const Sequence& sequence, const MaskStore& masks,
                   Progress& progress) {
  const double voxel = flags.voxel.empty() ? 0.0 : parse_positive("--voxel", flags.voxel);
  MapCollector kept(voxel);
  MapCollector removed(voxel);
  const ScanSource& scans = *sequence.scans;
  progress.begin("building the map", scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (interrupt_flag()) throw Cancelled();
    const Scan scan = scans.load(i);
    const Mask mask = masks.get(i);
    kept.add(scan, mask, 0);
    if (!flags.dynamic.empty()) removed.add(scan, mask, 1);
    progress.advance();
  }
  if (!flags.labels.empty()) {
    progress.begin("writing labels", scans.size());
    write_removals(flags.labels, scans, masks, [&] { progress.advance(); });
  }
  write_map(flags.dynamic, removed);
  write_map(flags.output, kept);
  progress.end();
}

ExitCode clean(const CleanFlags& flags) {
  if (flags.path.empty()) throw UsageError("clean what? Expected `raymoval clean PATH -o FILE`.");
  if (flags.output.empty()) throw UsageError("-o FILE is missing: name the cleaned map's file.");
  check_cloud_path(flags.output);
  if (!flags.dynamic.empty()) check_cloud_path(flags.dynamic);
  if (flags.output == flags.dynamic) throw UsageError("-o and --dynamic name the same file.");
  if (!flags.voxel.empty()) (void)parse_positive("--voxel", flags.voxel);
  const ConfiguredMethod method = configured(flags);
  Progress progress(flags.quiet ? ProgressStyle::kQuiet : progress_style_of_stderr());
  const int given = parse_threads(flags.threads);
  const Sequence sequence =
      open_sequence(flags.path, flags.reading.options(),
                    {given > 0 ? given : hardware_threads(), &progress, &interrupt_flag()});
  if (sequence.scans->size() == 0) {
    throw DataError("sequence '" + sequence.name + "' has no scan in the chosen frames (" +
                    sequence.frames + ").");
  }
  const MaskStore masks = find_removals(flags, method, sequence, progress);
  write_outputs(flags, sequence, masks, progress);
  std::size_t points = 0;
  for (std::size_t i = 0; i < masks.size(); ++i) points += masks.point_count(i);
  print(method.full_name() + " removed " + grouped_text(masks.removed_count()) + " of " +
        grouped_text(points) + " points in " + grouped_text(masks.size()) + " scans.\n");
  return ExitCode::kDone;
}

}  // namespace

Command add_clean_command(CLI::App& program) {
  auto flags = std::make_shared<CleanFlags>();
  CLI::App* app = program.add_subcommand("clean", "Writes a map without moving objects");
  app->allow_extras();
  app->add_option("path", flags->path, "Sequence folder, ROOT:05, `street`, or a scene")
      ->type_name("PATH");
  app->add_option("-o,--output", flags->output, "Cleaned map in the world frame: .pcd, .ply, .bin")
      ->type_name("FILE");
  app->add_option("--dynamic", flags->dynamic, "What was removed, as a map")->type_name("FILE");
  app->add_option("--labels", flags->labels, "Folder for a label file per scan (251 = removed)")
      ->type_name("DIR");
  app->add_option("--voxel", flags->voxel, "One point per cell of this size in metres");
  app->add_option("--method", flags->method, "Method (default: raymoval:offline)");
  app->add_option("--set", flags->settings, "Parameter: METHOD.key=value")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  flags->reading.add_to(*app);
  app->add_option("--threads", flags->threads, "At most so many threads (default: all cores)");
  app->add_flag("--quiet", flags->quiet, "No progress");
  app->footer(
      "Examples:\n"
      "  raymoval clean data/05 -o static.pcd\n"
      "  raymoval clean data/05 -o static.ply --dynamic removed.ply --voxel 0.1 "
      "--method raymoval:online");
  return {app, [flags] { return clean(*flags); }};
}

}  // namespace raymoval
