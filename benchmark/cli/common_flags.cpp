// SPDX-License-Identifier: MIT
#include <algorithm>

#include "benchmark/cli/command.h"
#include "benchmark/run/folder/run_folder.h"
#include "benchmark/suite/reading_options.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/parallel.h"
#include "core/process/proc_files.h"
#include "core/terminal_colour.h"
#include "core/text.h"
#include "datasets/reading/left_out.h"
#include "datasets/sequence_poses.h"

namespace raymoval {

int parse_threads(const std::string& text) {
  return text.empty() ? 0 : parse_whole("--threads", text, 1, 4096);
}

ProgressStyle progress_style(bool quiet) {
  return quiet ? ProgressStyle::kQuiet : progress_style_of_stderr();
}

void WorkFlags::add_to(CommandOptions& options) {
  options.add("--threads", "N", threads, "Use at most N threads (default: all cores)");
  options.add_flag("--quiet", quiet, "Show no progress");
}

int WorkFlags::thread_count() const {
  const int given = parse_threads(threads);
  return given > 0 ? given : hardware_threads();
}

void ProcessFlags::add_to(CommandOptions& options) {
  options.add(
      "--memory-limit", "SIZE", memory_limit,
      "Limit of memory, in MiB or with a unit such as 2GB (default: nine tenths of the machine's)");
  options.add_flag("--in-process", in_process,
                   "Run in this process, for a debugger; without a limit of memory");
}

double ProcessFlags::memory_limit_mib() const {
  return memory_limit.empty() ? usual_memory_limit_mib()
                              : parse_memory_mib("--memory-limit", memory_limit);
}

std::vector<std::string> ProcessFlags::child_arguments(const std::string& command) {
  std::vector<std::string> arguments = program_arguments();
  const auto found = std::find(arguments.begin(), arguments.end(), command);
  arguments.insert(found == arguments.end() ? found : found + 1, "--in-process");
  return arguments;
}

void OutputFlag::add_to(CommandOptions& options, const std::string& names,
                        const std::string& sentence) {
  option = names.substr(0, names.find(','));
  options.add(names, "FILE", path, sentence);
  options.add_flag("--overwrite", overwrite, "Replace the file of " + option + " if it is there");
}

void OutputFlag::check() const {
  if (path.empty()) return;
  const std::string shown = option + " " + path;
  const bool is_record = is_record_of_run(path);
  check_output_file(path, overwrite || is_record, shown);
  if (is_record) {
    throw UsageError(shown +
                     ": is a record of a run, which is never replaced. Choose another name.");
  }
}

void OutputFlag::check_is_none_of(const std::vector<std::filesystem::path>& inputs) const {
  const auto identity = path.empty() ? std::nullopt : identity_of(path);
  for (const std::filesystem::path& input : inputs) {
    if (!identity || identity != identity_of(input)) continue;
    throw UsageError(option + " " + path + ": is read as an input; choose another name.");
  }
}

void OutputFlag::write(const std::string& content) const {
  if (!path.empty()) write_atomically(output_target(path), content);
}

void PosesFlag::add_to(CommandOptions& options, bool with_overwrite) {
  const std::string sentence =
      "Also write the poses of the scans, as --poses reads them: in TUM's format, or in KITTI's if "
      "the name ends in .kitti or _kitti.txt";
  file.option = "--write-poses";
  if (with_overwrite) {
    file.add_to(options, file.option, sentence);
  } else {
    options.add(file.option, "FILE", file.path, sentence);
  }
}

void PosesFlag::write(const Sequence& sequence) const {
  if (file.path.empty()) return;
  file.check_is_none_of(sequence.input_files);
  file.write(pose_file_text(sequence, file.path));
}

void report_opening(const Sequence& sequence, Progress& progress) {
  progress.end();  // The messages get lines of their own.
  for (const std::string& line : sequence.notes) progress.say(sequence.name + ": " + line);
  for (const std::string& line : lost_scan_lines(sequence)) {
    print_warning(sequence.name + ": " + line);
  }
}

void SequenceFlags::add_place_to(CommandOptions& options, std::string& place) {
  options.add("path,--sequence", "PATH", place, "Sequence folder, ROOT:05, `street`, or a scene");
}

void SequenceFlags::add_to(CommandOptions& options) {
  for (const ReadingOption& option : reading_options()) {
    const std::string name = "--" + option.name;
    if (option.type.empty()) {
      options.add_flag(name, flags[option.name], option.sentence);
    } else {
      options.add(name, option.type, texts[option.name], option.sentence);
    }
  }
}

bool SequenceFlags::has(const ReadingOption& option) const {
  return option.type.empty() ? flags.at(option.name) : !texts.at(option.name).empty();
}

std::vector<std::filesystem::path> SequenceFlags::files() const {
  std::vector<std::filesystem::path> files;
  const std::string& rule = text("label-rule");
  if (!rule.empty() && is_rule_file(rule)) files.emplace_back(rule);
  const std::string& poses = text("poses");
  constexpr std::string_view kRefine = "refine:";
  if (!poses.empty())
    files.emplace_back(poses.substr(poses.starts_with(kRefine) ? kRefine.size() : 0));
  return files;
}

std::string SequenceFlags::first_given() const {
  for (const ReadingOption& option : reading_options()) {
    if (has(option)) return "--" + option.name;
  }
  return "";
}

SequenceOptions SequenceFlags::options() const {
  SequenceOptions options;
  for (const ReadingOption& option : reading_options()) {
    const bool is_flag = option.type.empty();
    if (has(option)) option.set(options, "--" + option.name, is_flag ? "" : text(option.name));
  }
  return options;
}

}  // namespace raymoval
