// SPDX-License-Identifier: MIT
#include "benchmark/cli/shell/manual_page.h"

#include <map>

#include "core/text.h"

namespace raymoval {
namespace {

/// `text` so that man shows it letter by letter: signs that are typed stay signs that can be
/// copied.
std::string escaped(std::string_view text) {
  static const std::map<char, const char*> signs = {
      {'\\', "\\e"}, {'-', "\\-"}, {'`', "\\(ga"}, {'\'', "\\(aq"}, {'^', "\\(ha"}, {'~', "\\(ti"}};
  std::string out = text.starts_with('.') ? "\\&" : "";
  for (const char letter : text) {
    const auto sign = signs.find(letter);
    out += sign == signs.end() ? std::string(1, letter) : sign->second;
  }
  return out;
}

std::string sentence(const std::string& text) {
  return escaped(text.ends_with('.') ? text : text + ".");
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string option_entry(const OptionText& option) {
  std::string text = ".TP\n";
  if (!option.short_name.empty()) text += bold(option.short_name) + ", ";
  text += option.long_name.empty() ? italic(option.value) : bold(option.long_name);
  if (!option.long_name.empty() && !option.value.empty()) text += " " + italic(option.value);
  if (option.repeats) text += " ...";
  return text + "\n" + sentence(option.sentence) + "\n";
}

/// The footer of a help page: lines that begin with blanks are examples, the others sentences.
std::string footer_text(const std::string& footer) {
  std::string text;
  bool example = false;
  for (const std::string_view line : split(footer, '\n')) {
    const bool indented = line.starts_with("  ");
    if (indented && !example) text += ".PP\n.nf\n.RS 4\n";
    if (!indented && example) text += ".RE\n.fi\n.PP\n";
    if (!indented && text.empty()) text += ".PP\n";
    if (!line.empty()) text += escaped(indented ? line.substr(2) : line) + "\n";
    example = indented;
  }
  return text + (example ? ".RE\n.fi\n" : "");
}

std::string synopsis(const CommandText& command) {
  std::string text = ".PP\n" + bold("raymoval " + command.name);
  if (!command.options.empty()) text += " [" + italic("OPTIONS") + "]";
  for (const OptionText& word : command.words) text += " [" + italic(word.value) + "]";
  return text + "\n";
}

std::string command_section(const CommandText& command) {
  std::string text = ".SS \"raymoval " + escaped(command.name) + "\"\n" +
                     sentence(command.sentence) + "\n" + synopsis(command);
  for (const OptionText& word : command.words) text += option_entry(word);
  for (const OptionText& option : command.options) text += option_entry(option);
  return text + footer_text(command.footer);
}

constexpr const char* kEnvironment = R"(.SH ENVIRONMENT
.TP
.B RAYMOVAL_CACHE
Folder for simulated scenes (default: ~/.cache/raymoval).
.TP
.B NO_COLOR
If it is set and not empty, nothing is coloured. Only terminals get colours.
)";

}  // namespace

std::string manual_page(const CommandTree& tree) {
  std::string text = ".TH RAYMOVAL 1 \"\" \"raymoval " RAYMOVAL_VERSION "\" \"User Commands\"\n";
  // "raymoval: evaluates the removal of ...", of which the name is said by the page itself.
  const std::string& whole = tree.program.sentence;
  const std::string purpose = whole.substr(whole.find(": ") + 2);
  text += ".SH NAME\nraymoval \\- " + escaped(purpose.substr(0, purpose.find_last_not_of('.') + 1));
  text += "\n.SH SYNOPSIS\n.B raymoval\n.I COMMAND\n[" + italic("OPTIONS") + "]\n";
  text +=
      ".SH DESCRIPTION\nraymoval " + sentence(purpose) + "\n" + footer_text(tree.program.footer);
  text += ".SH COMMANDS\n";
  for (const CommandText& command : tree.commands) text += command_section(command);
  return text + kEnvironment;
}

}  // namespace raymoval
