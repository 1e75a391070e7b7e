// SPDX-License-Identifier: MIT
#include "core/terminal_colour.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "core/text.h"

namespace raymoval {
namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

const char* sequence_of(TerminalColour colour) {
  switch (colour) {
    case TerminalColour::kGood:
      return "\x1b[32m";
    case TerminalColour::kBad:
      return "\x1b[1;31m";
    default:
      return "\x1b[33m";
  }
}

}  // namespace

bool shows_colours(std::FILE* stream) {
  const std::string_view terminal = variable("TERM");
  return variable("NO_COLOR").empty() && !terminal.empty() && terminal != "dumb" &&
         ::isatty(::fileno(stream)) != 0;
}

std::string coloured(const std::string& text, TerminalColour colour, std::FILE* stream) {
  return shows_colours(stream) ? sequence_of(colour) + text + "\x1b[0m" : text;
}

std::string coloured_phrases(const std::string& text,
                             const std::vector<std::pair<std::string, TerminalColour>>& phrases,
                             std::FILE* stream) {
  if (!shows_colours(stream)) return text;
  std::string out;
  for (const std::string_view line : split(text, '\n')) {
    std::string shown(line);
    for (const auto& [phrase, colour] : phrases) {
      if (line.starts_with(phrase + ":")) {
        shown.replace(0, phrase.size(), coloured(phrase, colour, stream));
      } else if (line.ends_with(" " + phrase + ".")) {
        shown.replace(line.size() - phrase.size() - 1, phrase.size(),
                      coloured(phrase, colour, stream));
      } else {
        continue;
      }
      break;
    }
    out += shown + "\n";
  }
  out.pop_back();  // `split` gives a last piece after the last line break.
  return out;
}

}  // namespace raymoval
