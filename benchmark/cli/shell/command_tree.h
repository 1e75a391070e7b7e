// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/cli/command_parser.h"
#include "methods/registry.h"

namespace raymoval {

/// What a shell offers where a value is expected.
struct ValueSet {
  std::string name;  ///< Letters and underscores: part of a shell function's name.
  std::vector<std::string> words = {};  ///< The known values.
  bool files = false;                   ///< A file will do as well.
  bool folders = false;                 ///< A folder will do as well.
  bool goes_on = false;  ///< More has to be typed after a word, such as after "tau1=".
};

/// The command line as texts: help pages, the manual page and the completion of shells are made
/// from it, so that none of them can say anything else.
struct CommandTree {
  CommandText program;
  std::vector<CommandText> commands;  ///< Those that are shown.
  std::vector<ValueSet> values;
};

/// @param program with its commands added
/// @param methods whose names are offered
CommandTree command_tree(const CommandParser& program, const MethodRegistry& methods);

/// The words that a sentence names first: "md (default), csv or tex" gives md, csv and tex.
std::vector<std::string> words_named_first(const std::string& sentence);

}  // namespace raymoval
