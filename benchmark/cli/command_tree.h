// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

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

/// An option of a command, or a word that stands alone.
struct OptionText {
  std::string long_name;   ///< "--method"; empty for a word that stands alone.
  std::string short_name;  ///< "-o", or empty.
  std::string sentence;    ///< As --help has it.
  std::string value;       ///< "NAME", as --help has it; empty if the option takes no value.
  std::string value_set;   ///< Name of a `ValueSet`; empty if the option takes no value.
  bool repeats = false;    ///< It may be given more than once.
};

struct CommandText {
  std::string name;
  std::string sentence;
  std::vector<OptionText> options;
  std::vector<OptionText> words;
  std::string footer;  ///< Sentences and examples as --help has them.
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
CommandTree command_tree(const CLI::App& program, const MethodRegistry& methods);

/// The words that a sentence names first: "md (default), csv or tex" gives md, csv and tex.
std::vector<std::string> words_named_first(const std::string& sentence);

}  // namespace raymoval
