// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace raymoval {

/// Declares the options of one command. It belongs to the parser that made it.
class CommandOptions {
 public:
  /// Adds an option that takes one value.
  /// @param names "--format", or "-o,--output", or "run" for a word without an option
  /// @param type the word for the value in --help, such as FILE
  /// @param value the destination of the value; must live until the command has run
  /// @param sentence the description in --help
  void add(const std::string& names, const std::string& type, std::string& value,
           const std::string& sentence);

  /// Adds an option that takes one value each time it is given, or any number of words without an
  /// option.
  void add(const std::string& names, const std::string& type, std::vector<std::string>& values,
           const std::string& sentence);

  /// Adds an option without a value: `value` is true if the option is given.
  void add_flag(const std::string& names, bool& value, const std::string& sentence);

  /// The heading in --help of the options that are added after this, such as "Method options".
  void group(const std::string& heading) { group_ = heading; }

  /// Replaces the sentence of an option.
  void set_sentence(const std::string& name, const std::string& sentence);

  /// Sets the text of --help below the options.
  void set_footer(const std::string& text);

  /// Leaves the command out of --help.
  void hide();

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  friend class CommandParser;
  CommandOptions(void* command, std::string name) : command_(command), name_(std::move(name)) {}

  void* command_;  ///< A CLI::App.
  std::string name_;
  std::string group_ = "Options";
};

/// Reads the command line. It hides CLI11, whose headers take ten seconds to compile: only
/// command_parser.cpp includes them.
class CommandParser {
 public:
  /// @param sentence what the program does
  /// @param name the program's name
  explicit CommandParser(const std::string& sentence, const std::string& name);
  ~CommandParser();
  CommandParser(const CommandParser&) = delete;
  CommandParser& operator=(const CommandParser&) = delete;

  /// Adds --version, which prints `text`.
  void set_version(const std::string& text);
  /// Sets the last text of the program's --help.
  void set_footer(const std::string& text);

  CommandOptions add_command(const std::string& name, const std::string& sentence);

  /// Reads the command line and stores the values of the chosen command's options.
  /// @return the chosen command's name, or "" if --help or --version was given: see `answer`
  /// @throws UsageError that names the wrong word and the nearest known command or option
  [[nodiscard]] std::string parse(int argc, const char* const* argv);

  /// The text of --help or --version, after `parse` returned "".
  [[nodiscard]] const std::string& answer() const;

  /// The text of --help: of a command, or of the program if `command` is empty.
  /// @throws UsageError if no command that is shown has this name
  [[nodiscard]] std::string help_page(const std::string& command) const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace raymoval
