// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/picture/charts/charts.h"
#include "benchmark/picture/maps/map_picture.h"
#include "benchmark/run/folder/kept_run.h"
#include "benchmark/tables/table_options.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct PictureFlags {
  std::string run, kind = "map";
  OutputFlag output;
  std::vector<std::string> only;
  std::string crop, resolution, size, protocol, data;
  bool simulate = false;
  WorkFlags work;
};

const std::vector<std::string>& kinds() {
  static const std::vector<std::string> names = {"map", "pr-rr", "accuracy-time", "sweep"};
  return names;
}

bool is_chart(const std::string& kind) {
  return kind != "map";
}

/// @throws UsageError for an option that has no effect on the kind of picture
void check_options(const PictureFlags& flags) {
  const std::pair<const char*, bool> of_maps[] = {{"--only", !flags.only.empty()},
                                                  {"--crop", !flags.crop.empty()},
                                                  {"--resolution", !flags.resolution.empty()},
                                                  {"--size", !flags.size.empty()},
                                                  {"--data", !flags.data.empty()},
                                                  {"--simulate", flags.simulate}};
  for (const auto& [option, given] : of_maps) {
    if (!given || flags.kind == "map") continue;
    throw UsageError(std::string(option) + " needs --kind map, not with " + flags.kind + ".");
  }
  if (!flags.protocol.empty() && flags.kind == "map") {
    throw UsageError("--protocol needs a chart (--kind pr-rr, accuracy-time or sweep).");
  }
}

void check_flags(const PictureFlags& flags) {
  if (flags.run.empty())
    throw UsageError("RUN is missing: expected `raymoval picture RUN -o FILE`.");
  if (!is_among(kinds(), flags.kind)) {
    throw UsageError("--kind " + flags.kind + " is unknown." + suggestion(flags.kind, kinds()));
  }
  const std::string extension = is_chart(flags.kind) ? ".svg" : ".png";
  if (flags.output.path.empty()) {
    throw UsageError("-o FILE" + extension + " is missing: name the picture's file.");
  }
  if (std::filesystem::path(flags.output.path).extension() != extension) {
    throw UsageError("-o " + flags.output.path + ": --kind " + flags.kind + " makes a " +
                     extension + " file. Give the name this ending.");
  }
  check_options(flags);
  flags.output.check();
}

WorldWindow parse_crop(const std::string& text) {
  std::array<double, 4> values{};
  const auto parts = split(text, ':');
  bool good = parts.size() == 4;
  for (std::size_t i = 0; good && i < 4; ++i) {
    const auto value = parse_number<double>(parts[i]);
    good = value.has_value() && std::abs(*value) < 1e6;
    if (good) values[i] = *value;
  }
  if (!good || !(values[1] > values[0] && values[3] > values[2])) {
    throw UsageError("--crop " + text +
                     ": expected XMIN:XMAX:YMIN:YMAX in metres of the world frame, such as "
                     "-20:60:-15:15.");
  }
  return {values[0], values[1], values[2], values[3]};
}

Canvas drawn(const PictureFlags& flags, Progress& progress) {
  MapPictureOptions map;
  map.only = flags.only;
  if (!flags.crop.empty()) map.crop = parse_crop(flags.crop);
  if (!flags.resolution.empty()) map.resolution = parse_positive("--resolution", flags.resolution);
  if (!flags.size.empty()) {
    map.panel_pixels = parse_whole("--size", flags.size, 50, 8000, "a whole number of pixels");
  }
  const OpenContext context{flags.work.thread_count(), &progress, &interrupt_flag()};
  const KeptRun run(flags.run, flags.data, flags.simulate);
  return map_picture(run, map, context);
}

/// The chart with notes below it on how methods differ from their variants.
Chart noted(Chart chart, const RunResults& results) {
  for (const ChangedMethod& changed : results.changed) chart.add_note(changed.note());
  return chart;
}

/// The requested chart. @throws DataError if the run has no data for it
Chart charted(const PictureFlags& flags) {
  const RunResults results = KeptRun(flags.run, "").results();
  RunResults checked = results;
  if (!flags.protocol.empty()) choose_protocols(checked, {flags.protocol});
  const auto chart = flags.kind == "pr-rr"   ? pr_rr_chart
                     : flags.kind == "sweep" ? sweep_chart
                                             : accuracy_time_chart;
  for (const std::string& protocol : checked.protocols) {
    Chart drawing = chart(results, protocol);
    if (!drawing.empty()) return noted(std::move(drawing), results);
  }
  throw DataError(flags.run + ": no method has what --kind " + flags.kind +
                  " shows; see `raymoval table " + flags.run + "`.");
}

ExitCode draw(const PictureFlags& flags) {
  check_flags(flags);
  Progress progress(flags.work.style());
  try {
    if (is_chart(flags.kind)) {
      flags.output.write(charted(flags).svg());
    } else {
      flags.output.write(drawn(flags, progress).png_bytes());
    }
  } catch (...) {
    progress.end();
    throw;
  }
  progress.end();
  return ExitCode::kDone;
}

void add_options(CommandOptions& options, PictureFlags& flags) {
  options.add("run", "RUN", flags.run, "The run folder");
  flags.output.add_to(options, "-o,--output",
                      "The picture, a .png file, or of a chart a .svg file");
  options.add("--kind", "KIND", flags.kind,
              "map (default), pr-rr, accuracy-time or sweep; the last three are charts");
  options.add(
      "--only", "PATTERN", flags.only,
      "map: only the cells whose SEQUENCE/NAME, SEQUENCE or NAME matches this pattern (* and ?); "
      "default: all but the controls");
  options.add("--crop", "WINDOW", flags.crop,
              "map: XMIN:XMAX:YMIN:YMAX in metres of the world frame (default: the sensor's path "
              "and 30 m around it)");
  options.add("--resolution", "METRES", flags.resolution,
              "map: metres per pixel (default: --size decides)");
  options.add("--size", "PIXELS", flags.size, "map: the longer side of a panel in pixels");
  options.add("--protocol", "NAME", flags.protocol, "Charts: the protocol that is shown");
  options.add("--data", "PATH", flags.data,
              "Folder of the data, if it was moved since the run: that of the sequence, or one "
              "with all sequences by name");
  options.add_flag("--simulate", flags.simulate,
                   "map: simulate scenes of the run that are not in the cache; they may be large");
  flags.work.add_to(options);
}

}  // namespace

Command add_picture_command(CommandParser& program) {
  auto flags = std::make_shared<PictureFlags>();
  CommandOptions options = program.add_command("picture", "Draws maps and charts of a run");
  add_options(options, *flags);
  options.set_footer(
      "Maps need a run with --keep-removals, and its data. They show the evaluated points.\n"
      "A pixel of a map with at least one moving point per ten static points shows the verdict on "
      "most of\n"
      "its moving points, another pixel that on most of its static points. Charts need only the "
      "run folder.\n"
      "Examples:\n"
      "  raymoval run --sequence data/05 --frames 0:100 --method raymoval:offline --keep-removals "
      "--out out/05\n"
      "  raymoval picture out/05 -o maps.png\n"
      "  raymoval picture out/05 -o map.png --only '05/raymoval*' --size 800\n"
      "  raymoval picture out/05 -o detail.png --crop -20:60:-15:15 --resolution 0.1\n"
      "  raymoval run simulated --out out/simulated\n"
      "  raymoval picture out/simulated -o rates.svg --kind pr-rr");
  return {options.name(), [flags] { return draw(*flags); }};
}

}  // namespace raymoval
