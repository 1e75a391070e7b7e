// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "benchmark/cli/command_parser.h"
#include "benchmark/suite/amounts.h"
#include "benchmark/suite/reading_options.h"
#include "core/error.h"
#include "core/progress.h"
#include "datasets/sequence.h"
#include "methods/registry.h"

namespace raymoval {

/// A command of the program: its options, and the function that runs it.
struct Command {
  std::string name;
  std::function<ExitCode()> run;
};

/// One function per command, each in its own file commands/command_<name>.cpp.
Command add_run_command(CommandParser& program);
Command add_plan_command(CommandParser& program);
Command add_run_method_command(CommandParser& program);  ///< The child's side of `run`; not shown.
Command add_table_command(CommandParser& program);
Command add_picture_command(CommandParser& program);
Command add_compare_command(CommandParser& program);
Command add_list_command(CommandParser& program);
Command add_describe_command(CommandParser& program);
Command add_cite_command(CommandParser& program);
Command add_score_command(CommandParser& program);
Command add_clean_command(CommandParser& program);
Command add_simulate_command(CommandParser& program);
Command add_inspect_command(CommandParser& program);
Command add_report_command(CommandParser& program);
/// `program` must outlive this command.
Command add_help_command(CommandParser& program);

/// The arguments of the program, without its own name.
const std::vector<std::string>& program_arguments();

/// The registry that was passed to `run_command_line`.
const MethodRegistry& program_methods();

/// Options for reading sequences, as texts of the command line.
struct SequenceFlags {
  std::map<std::string, std::string> texts;  ///< By the option's name, such as "pose-format".
  std::map<std::string, bool> flags;

  void add_to(CommandOptions& options);
  /// Adds the sequence of a command, which may be given with --sequence or without it.
  static void add_place_to(CommandOptions& options, std::string& place);
  /// @throws UsageError for an ill-formed value
  [[nodiscard]] SequenceOptions options() const;
  /// The first of these options that was given, such as "--frames"; empty if none was.
  [[nodiscard]] std::string first_given() const;
  /// The files that these options name.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;
  /// The value of an option; empty if it was not given.
  [[nodiscard]] const std::string& text(const std::string& name) const { return texts.at(name); }

 private:
  [[nodiscard]] bool has(const ReadingOption& option) const;
};

/// The number of `--threads N`, or 0 if it was not given.
/// @throws UsageError unless it is a whole number from 1 to 4096
int parse_threads(const std::string& text);

/// How progress is shown: on standard error, unless `quiet` is set.
ProgressStyle progress_style(bool quiet);

/// The options --threads and --quiet of a long-running command.
struct WorkFlags {
  std::string threads;
  bool quiet = false;

  void add_to(CommandOptions& options);
  /// The number of threads of --threads, or one for each core. @throws UsageError
  [[nodiscard]] int thread_count() const;
  [[nodiscard]] ProgressStyle style() const { return progress_style(quiet); }
};

/// The options --memory-limit and --in-process of a command that works in a child process.
struct ProcessFlags {
  std::string memory_limit;
  bool in_process = false;

  void add_to(CommandOptions& options);
  /// The limit that was given, or the usual limit of the machine. @throws UsageError
  [[nodiscard]] double memory_limit_mib() const;
  /// The arguments of the command line plus the option that makes the child do the work itself.
  [[nodiscard]] static std::vector<std::string> child_arguments(const std::string& command);
};

/// The output file of a command that also prints, and --overwrite.
struct OutputFlag {
  std::string option;  ///< Such as "--json".
  std::string path;    ///< Empty if it was not given.
  bool overwrite = false;

  /// @param names of the option, such as "-o,--output"
  void add_to(CommandOptions& options, const std::string& names, const std::string& sentence);
  /// Called before the work. @throws UsageError if the file's folder is missing, if the file exists
  /// without --overwrite, or if it is a record of a run
  void check() const;
  /// @param inputs files that are read
  /// @throws UsageError if the output is one of them
  void check_is_none_of(const std::vector<std::filesystem::path>& inputs) const;
  /// Writes the content if a file was given. @throws DataError
  void write(const std::string& content) const;
};

/// The option --write-poses of a command that opens a sequence.
struct PosesFlag {
  OutputFlag file;

  /// @param with_overwrite whether the command has no --overwrite of its own
  void add_to(CommandOptions& options, bool with_overwrite);
  /// Writes the poses of `sequence` if a file was given. @throws UsageError, DataError
  void write(const Sequence& sequence) const;
};

/// Prints how a sequence was opened, unless progress is quiet. Always warns of scans that are lost.
void report_opening(const Sequence& sequence, Progress& progress);

/// Set to true by the first Ctrl-C, SIGTERM or SIGHUP; a second one ends the program at once. The
/// exit code is then 128 + the number of the signal, unless the work was already complete.
const std::atomic<bool>& interrupt_flag();

/// Prints to standard output, escaped by `terminal_text`: names and reasons may come from foreign
/// files.
/// @throws DataError if it cannot be written (a full disk, a closed pipe)
void print(const std::string& text);

}  // namespace raymoval
