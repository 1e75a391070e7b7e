// SPDX-License-Identifier: MIT
#include "benchmark/cli/completion.h"

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
  return text;
}

std::string head(const std::string& shell) {
  return "# Completes raymoval in " + shell + ". Made by `raymoval completion " + shell + "`.\n";
}

const ValueSet* find_set(const CommandTree& tree, const std::string& name) {
  for (const ValueSet& set : tree.values) {
    if (set.name == name) return &set;
  }
  return nullptr;
}

// --- bash ---

/// The lines of a case that say which set of values follows each option of a command.
std::string bash_values_of(const CommandText& command) {
  std::string text;
  for (const OptionText& option : command.options) {
    if (option.value_set.empty()) continue;
    const std::string names =
        "\"" + command.name + " " + option.long_name + "\"" +
        (option.short_name.empty() ? "" : " | \"" + command.name + " " + option.short_name + "\"");
    text += "    " + names + ") echo " + option.value_set + " ;;\n";
  }
  for (const OptionText& word : command.words) {
    text += "    \"" + command.name + " word\") echo " + word.value_set + " ;;\n";
    break;  // The first decides: of the commands with two words both are run folders.
  }
  return text;
}

std::string bash_options_of(const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    names.push_back(option.long_name.empty() ? option.short_name : option.long_name);
  }
  return "    \"" + command.name + "\") echo \"" + join(names, " ") + "\" ;;\n";
}

std::string bash_words_of(const ValueSet& set) {
  if (set.words.empty()) return "";
  return "    " + set.name + ") echo \"" + join(set.words, " ") + "\" ;;\n";
}

/// Names of the sets for which `wanted` is true, as a pattern of a case.
template <class Wanted>
std::string bash_sets(const CommandTree& tree, Wanted wanted) {
  std::vector<std::string> names;
  for (const ValueSet& set : tree.values) {
    if (wanted(set)) names.push_back(set.name);
  }
  return join(names, " | ");
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
  std::string text = head("bash");
  text += "_raymoval_set() {\n  case $1 in\n";
  for (const CommandText& command : tree.commands) text += bash_values_of(command);
  text += "  esac\n}\n_raymoval_options() {\n  case $1 in\n";
  CommandText program = tree.program;
  program.name.clear();
  text += bash_options_of(program);
  for (const CommandText& command : tree.commands) text += bash_options_of(command);
  text += "  esac\n}\n_raymoval_words() {\n  case $1 in\n";
  for (const ValueSet& set : tree.values) text += bash_words_of(set);
  text += "  esac\n}\n_raymoval_paths() {\n  case $1 in\n";
  text += "    " + bash_sets(tree, [](const ValueSet& set) { return set.files; }) +
          ") compopt -o bashdefault -o default 2>/dev/null ;;\n";
  text += "    " + bash_sets(tree, [](const ValueSet& set) { return set.folders; }) +
          ") compopt -o plusdirs 2>/dev/null ;;\n";
  text += "    " + bash_sets(tree, [](const ValueSet& set) { return set.goes_on; }) +
          ") compopt -o nospace 2>/dev/null ;;\n";
  return text + "  esac\n}" + kBashFunction;
}

// --- zsh ---

std::string zsh_quoted(const std::string& text) {
  return "'" + replaced(text, "'", R"('\'')") + "'";
}

/// `text` within the brackets or between the colons of a spec of _arguments.
std::string zsh_escaped(std::string text) {
  for (const char* special : {"\\", "[", "]", ":"})
    text = replaced(text, special, std::string("\\") + special);
  return text;
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
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

/// What follows an option or stands alone: the words of a set, and files if they will do.
std::string fish_values(const ValueSet* set) {
  if (set == nullptr) return "";
  std::string text = set->files || set->folders ? " -F" : " -f";
  if (!set->words.empty()) text += " -a " + fish_quoted(join(set->words, " "));
  return text;
}

std::string fish_option(const CommandTree& tree, const std::string& when,
                        const OptionText& option) {
  std::string text = "complete -c raymoval -n " + fish_quoted(when);
  if (!option.short_name.empty()) text += " -s " + option.short_name.substr(1);
  if (!option.long_name.empty()) text += " -l " + option.long_name.substr(2);
  if (!option.value_set.empty()) text += " -r" + fish_values(find_set(tree, option.value_set));
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
      text += "complete -c raymoval -n " + fish_quoted(when) +
              fish_values(find_set(tree, word.value_set)) + "\n";
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
