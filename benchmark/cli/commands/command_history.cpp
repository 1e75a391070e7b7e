// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/cli/command.h"
#include "benchmark/history/history_json.h"
#include "benchmark/history/history_table.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/result/speed/speed_comparison.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

struct HistoryFlags {
  std::string folder = "results/history", band, format = "text", output;
  std::vector<std::string> methods, sequences;
  bool all = false;
};

/// Leaves the lines of one of `names`; a method's name stands for all its variants.
void choose(const std::string& option, const std::vector<std::string>& names,
            std::string HistoryLine::*field, std::vector<HistoryLine>& lines) {
  if (names.empty()) return;
  std::vector<std::string> known;
  for (const HistoryLine& line : lines) {
    if (std::find(known.begin(), known.end(), line.*field) == known.end())
      known.push_back(line.*field);
  }
  const auto fits = [](const std::string& text, const std::string& name) {
    return text == name || text.starts_with(name + ":");
  };
  for (const std::string& name : names) {
    const bool there = std::any_of(known.begin(), known.end(),
                                   [&](const std::string& text) { return fits(text, name); });
    if (!there)
      throw UsageError(option + " " + name + ": the history has none of this name." +
                       suggestion(name, known));
  }
  std::erase_if(lines, [&](const HistoryLine& line) {
    return std::none_of(names.begin(), names.end(),
                        [&](const std::string& name) { return fits(line.*field, name); });
  });
}

std::string plain_text(const std::vector<TextTable>& tables) {
  std::string text;
  for (const TextTable& table : tables) {
    text += (text.empty() ? "" : "\n") + table.title + "\n";
    std::string block;
    for (const RowRange& rows : blocks_of(table)) {
      TextTable part{table.title, table.corner, table.groups, {}, {}};
      part.rows.assign(table.rows.begin() + static_cast<std::ptrdiff_t>(rows.first),
                       table.rows.begin() + static_cast<std::ptrdiff_t>(rows.end));
      text += "\n" + part.rows.front().block + "\n" + to_plain(part);
    }
    for (const std::string& note : table.notes) text += "\n" + wrapped(note, kTerminalWidth);
  }
  return text;
}

std::string text_of(const std::vector<HistoryTrack>& tracks, const HistoryFlags& flags,
                    double band) {
  if (flags.format == "json") return json_text(to_json(tracks));
  const std::vector<TextTable> tables = history_tables(tracks, band, flags.all);
  if (flags.format == "text") return plain_text(tables);
  std::string text;
  for (const TextTable& table : tables) text += (text.empty() ? "" : "\n") + to_markdown(table);
  return text;
}

ExitCode history(const HistoryFlags& flags) {
  const std::vector<std::string> formats = {"text", "json", "md"};
  if (std::find(formats.begin(), formats.end(), flags.format) == formats.end())
    throw UsageError("--format " + flags.format + ": expected text, json or md." +
                     suggestion(flags.format, formats));
  double band = kSpeedBand;
  if (!flags.band.empty()) band = parse_positive("--time-band", flags.band);
  if (band < 1.0)
    throw UsageError("--time-band " + flags.band +
                     ": expected a factor of at least 1, such as 1.5.");
  if (!flags.output.empty()) check_folder_of(flags.output);
  std::vector<HistoryLine> lines = read_history(flags.folder);
  choose("--sequence", flags.sequences, &HistoryLine::sequence, lines);
  choose("--method", flags.methods, &HistoryLine::method, lines);
  const std::string text = text_of(history_tracks(lines, band), flags, band);
  if (flags.output.empty()) {
    print(text);
  } else {
    write_atomically(output_target(flags.output), text);
  }
  return ExitCode::kDone;
}

}  // namespace

Command add_history_command(CommandParser& program) {
  auto flags = std::make_shared<HistoryFlags>();
  CommandOptions options = program.add_command(
      "history", "Shows at which commits a method's answers or its speed changed");
  options.add("folder", "FOLDER", flags->folder,
              "Folder with files *.jsonl, or one such file (default: results/history)");
  options.add("--method", "NAME", flags->methods, "Only this method, with a variant or with all");
  options.add("--sequence", "NAME", flags->sequences, "Only this scene");
  options.add("--time-band", "FACTOR", flags->band,
              "By which factor a time may change before it counts (default: 1.3)");
  options.add_flag("--all", flags->all, "Show commits at which nothing changed, too");
  options.add("--format", "FORMAT", flags->format, "text, json or md (default: text)");
  options.add("-o,--output", "FILE", flags->output, "Write to this file");
  options.set_footer(
      "scripts/record.sh appends what a commit scores. Counts are compared exactly; a time is a\n"
      "multiple of the time of a fixed kernel on the same machine.\nExamples:\n"
      "  raymoval history\n"
      "  raymoval history --method raymoval_plus --sequence street\n"
      "  raymoval history results/history --format md -o history.md\n"
      "  raymoval history results/history --time-band 1.5 --all");
  return {options.name(), [flags] { return history(*flags); }};
}

}  // namespace raymoval
