// SPDX-License-Identifier: MIT
#include "benchmark/cli/shell/completion.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// `text` with a backslash before each of the `special` characters.
std::string backslashed(const std::string& text, std::string_view special) {
  std::string out;
  for (const char letter : text) {
    if (special.find(letter) != std::string_view::npos) out += '\\';
    out += letter;
  }
  return out;
}

std::string head(const std::string& shell) {
  return fmt::format("# Completes raymoval in {0}. Made by `raymoval completion {0}`.\n", shell);
}

// --- bash ---

/// A branch of a case that prints `answer`.
std::string bash_branch(const std::string& pattern, const std::string& answer) {
  return fmt::format("    {}) echo {} ;;\n", pattern, answer);
}

/// The branches that say which set of values follows each option of a command.
std::string bash_values_of(const CommandText& command) {
  std::string text;
  for (const OptionText& option : command.options) {
    if (option.value_set.empty()) continue;
    std::string names = fmt::format("\"{} {}\"", command.name, option.long_name);
    if (!option.short_name.empty()) {
      names += fmt::format(" | \"{} {}\"", command.name, option.short_name);
    }
    text += bash_branch(names, option.value_set);
  }
  // The first word decides: of the commands with two words both are run folders.
  if (command.words.empty()) return text;
  return text + bash_branch("\"" + command.name + " word\"", command.words.front().value_set);
}

std::string bash_options_of(const std::string& name, const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    names.push_back(option.long_name.empty() ? option.short_name : option.long_name);
  }
  return bash_branch("\"" + name + "\"", "\"" + join(names, " ") + "\"");
}

/// A branch that sets how bash completes the paths of the sets for which `kind` is true.
std::string bash_paths(const CommandTree& tree, bool ValueSet::*kind, const char* options) {
  std::vector<std::string> names;
  for (const ValueSet& set : tree.values) {
    if (set.*kind) names.push_back(set.name);
  }
  return fmt::format("    {}) compopt {} 2>/dev/null ;;\n", join(names, " | "), options);
}

// The line is taken apart at blanks, for bash itself also takes it apart at : and =, which stand in
// names of methods and in settings. What it has taken off is taken off the answers.
constexpr const char* kBashFunction = R"bash(
_raymoval() {
  local line=${COMP_LINE:0:COMP_POINT} words current previous command= set= prefix= typed breaks=
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=("")
  current=${words[-1]}
  [[ ${#words[@]} -gt 1 ]] && previous=${words[-2]}
  [[ ${#words[@]} -gt 2 ]] && command=${words[1]}
  COMPREPLY=()
  if [[ $current == --*=* ]]; then
    prefix=${current%%=*}=
    set=$(_raymoval_set "$command ${current%%=*}")
    current=${current#*=}
  elif [[ $previous == -* ]]; then
    set=$(_raymoval_set "$command $previous")
  fi
  if [[ -z $set && $current == -* ]]; then
    COMPREPLY=($(compgen -W "$(_raymoval_options "$command")" -- "$current"))
    return
  fi
  if [[ -z $set && -z $command ]]; then
    set=commands
  elif [[ -z $set ]]; then
    set=$(_raymoval_set "$command word")
  fi
  COMPREPLY=($(compgen -W "$(_raymoval_words "$set")" -P "$prefix" -- "$current"))
  typed=$prefix$current
  [[ $COMP_WORDBREAKS == *:* ]] && breaks+=:
  [[ $COMP_WORDBREAKS == *=* ]] && breaks+==
  if [[ -n $breaks && $typed == *[$breaks]* ]]; then
    COMPREPLY=("${COMPREPLY[@]#"${typed%"${typed##*[$breaks]}"}"}")
  fi
  _raymoval_paths "$set"
}
complete -F _raymoval raymoval
)bash";

std::string bash_script(const CommandTree& tree) {
  std::string values, options = bash_options_of("", tree.program), words;
  for (const CommandText& command : tree.commands) {
    values += bash_values_of(command);
    options += bash_options_of(command.name, command);
  }
  for (const ValueSet& set : tree.values) {
    if (!set.words.empty()) words += bash_branch(set.name, "\"" + join(set.words, " ") + "\"");
  }
  std::string text = head("bash");
  for (const auto& [function, branches] :
       {std::pair<const char*, std::string>{"set", values},
        {"options", options},
        {"words", words},
        {"paths", bash_paths(tree, &ValueSet::files, "-o bashdefault -o default") +
                      bash_paths(tree, &ValueSet::folders, "-o plusdirs") +
                      bash_paths(tree, &ValueSet::goes_on, "-o nospace")}}) {
    text += fmt::format("_raymoval_{}() {{\n  case $1 in\n{}  esac\n}}\n", function, branches);
  }
  return text + (kBashFunction + 1);  // Without the line break before the function.
}

// --- zsh ---

std::string zsh_quoted(const std::string& text) {
  std::string quoted;
  for (const char letter : text) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  return "'" + quoted + "'";
}

/// `text` within the brackets or between the colons of a spec of _arguments.
std::string zsh_escaped(const std::string& text) {
  return backslashed(text, "\\[]:");
}

std::string zsh_function_of(const ValueSet& set) {
  std::string text = "_raymoval_" + set.name + "() {\n";
  if (!set.words.empty()) {
    text += std::string("  compadd ") + (set.goes_on ? "-S '' " : "") + "--";
    for (const std::string& word : set.words) text += " " + zsh_quoted(word);
    text += "\n";
  }
  if (set.files) text += "  _files\n";
  if (set.folders) text += "  _files -/\n";
  return text + (text.ends_with("{\n") ? "  _message value\n}\n" : "}\n");
}

std::string zsh_option(const OptionText& option, const std::string& name, const char* separator) {
  const std::string names = option.short_name.empty() || option.long_name.empty()
                                ? ""
                                : "(" + option.short_name + " " + option.long_name + ")";
  std::string spec = option.repeats ? "*" : names;
  spec += name + (option.value_set.empty() ? "" : separator);
  spec += "[" + zsh_escaped(option.sentence) + "]";
  if (!option.value_set.empty()) {
    spec += ":" + zsh_escaped(option.value) + ":_raymoval_" + option.value_set;
  }
  return " \\\n        " + zsh_quoted(spec);
}

std::string zsh_case_of(const CommandText& command) {
  std::string text = "    " + command.name + ")\n      _arguments";
  for (const OptionText& option : command.options) {
    if (!option.short_name.empty()) text += zsh_option(option, option.short_name, "");
    if (!option.long_name.empty()) text += zsh_option(option, option.long_name, "=");
  }
  for (const OptionText& word : command.words) {
    text += " \\\n        " +
            zsh_quoted(":" + zsh_escaped(word.value) + ":_raymoval_" + word.value_set);
  }
  return text + " ;;\n";
}

std::string zsh_script(const CommandTree& tree) {
  std::string text = "#compdef raymoval\n" + head("zsh");
  for (const ValueSet& set : tree.values) text += zsh_function_of(set);
  text += "_raymoval() {\n  local curcontext=$curcontext state line\n  _arguments -C";
  for (const OptionText& option : tree.program.options) {
    text += zsh_option(option, option.long_name, "=");
  }
  text += " \\\n        '1:command:->command' '*::word:->rest'\n  case $state in\n    command)\n";
  text += "      local -a commands=(";
  for (const CommandText& command : tree.commands) {
    text += "\n        " + zsh_quoted(command.name + ":" + command.sentence);
  }
  text +=
      ")\n      _describe command commands\n      return ;;\n    rest) ;;\n    *) return ;;\n"
      "  esac\n  case $words[1] in\n";
  for (const CommandText& command : tree.commands) text += zsh_case_of(command);
  return text +
         "  esac\n}\nif [[ ${funcstack[1]} == _raymoval ]]; then\n  _raymoval \"$@\"\nelse\n"
         "  compdef _raymoval raymoval\nfi\n";
}

// --- fish ---

std::string fish_quoted(const std::string& text) {
  return "'" + backslashed(text, "\\'") + "'";
}

/// What follows an option or stands alone: the words of a set, and files if they will do.
std::string fish_values(const CommandTree& tree, const std::string& name) {
  const auto set = std::find_if(tree.values.begin(), tree.values.end(),
                                [&](const ValueSet& known) { return known.name == name; });
  if (set == tree.values.end()) return "";
  return (set->files || set->folders ? " -F" : " -f") +
         (set->words.empty() ? "" : " -a " + fish_quoted(join(set->words, " ")));
}

std::string fish_option(const CommandTree& tree, const std::string& when,
                        const OptionText& option) {
  std::string text = "complete -c raymoval -n " + fish_quoted(when);
  if (!option.short_name.empty()) text += " -s " + option.short_name.substr(1);
  if (!option.long_name.empty()) text += " -l " + option.long_name.substr(2);
  if (!option.value_set.empty()) text += " -r" + fish_values(tree, option.value_set);
  return text + " -d " + fish_quoted(option.sentence) + "\n";
}

std::string fish_script(const CommandTree& tree) {
  std::string text = head("fish") + "complete -c raymoval -f\n";
  for (const OptionText& option : tree.program.options) {
    text += fish_option(tree, "__fish_use_subcommand", option);
  }
  for (const CommandText& command : tree.commands) {
    text += "complete -c raymoval -n __fish_use_subcommand -a " + command.name + " -d " +
            fish_quoted(command.sentence) + "\n";
    const std::string when = "__fish_seen_subcommand_from " + command.name;
    for (const OptionText& option : command.options) text += fish_option(tree, when, option);
    for (const OptionText& word : command.words) {
      text +=
          "complete -c raymoval -n " + fish_quoted(when) + fish_values(tree, word.value_set) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string completion_script(const CommandTree& tree, const std::string& shell) {
  if (shell == "bash") return bash_script(tree);
  if (shell == "zsh") return zsh_script(tree);
  if (shell == "fish") return fish_script(tree);
  throw UsageError("'" + shell + "' is no shell that can be completed." +
                   suggestion(shell, {"bash", "zsh", "fish"}));
}

}  // namespace raymoval
