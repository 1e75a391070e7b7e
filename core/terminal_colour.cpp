// SPDX-License-Identifier: MIT
#include "core/terminal_colour.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

constexpr const char* kPlain = "\x1b[0m";

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

/// Length of an escape sequence of `coloured` at position `at`; 0 if there is none.
std::size_t colour_length(const std::string& text, std::size_t at) {
  for (const std::string_view known :
       {std::string_view(kPlain), std::string_view(sequence_of(TerminalColour::kGood)),
        std::string_view(sequence_of(TerminalColour::kBad)),
        std::string_view(sequence_of(TerminalColour::kNotice))}) {
    if (text.compare(at, known.size(), known) == 0) return known.size();
  }
  return 0;
}

}  // namespace

bool shows_colours(std::FILE* stream) {
  const std::string_view terminal = variable("TERM");
  return variable("NO_COLOR").empty() && !terminal.empty() && terminal != "dumb" &&
         ::isatty(::fileno(stream)) != 0;
}

std::string coloured(const std::string& text, TerminalColour colour, std::FILE* stream) {
  return shows_colours(stream) ? sequence_of(colour) + text + kPlain : text;
}

std::string terminal_text(const std::string& text, std::FILE* stream) {
  const bool with_colours = shows_colours(stream);
  std::string safe, piece;
  const auto end_piece = [&] {
    safe += printable_text(piece);
    piece.clear();
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    const std::size_t colour = with_colours ? colour_length(text, at) : 0;
    if (colour == 0 && text[at] != '\n' && text[at] != '\t') {
      piece += text[at];
      continue;
    }
    end_piece();
    safe.append(text, at, std::max<std::size_t>(colour, 1));
    at += std::max<std::size_t>(colour, 1) - 1;
  }
  end_piece();
  return safe;
}

void print_error(const std::string& line) {
  std::fprintf(stderr, "%s\n", terminal_text(line, stderr).c_str());
}

void print_warning(const std::string& line) {
  print_error("raymoval: warning: " + line);
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
