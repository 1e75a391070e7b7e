// SPDX-License-Identifier: MIT
#include "core/terminal_colour.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/utf8.h"

namespace raymoval {
namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

constexpr std::string_view kRed = "\x1b[1;31m", kPlain = "\x1b[0m";

/// Length of an escape sequence of `in_red` at position `at`; 0 if there is none.
std::size_t colour_length(const std::string& text, std::size_t at) {
  for (const std::string_view known : {kPlain, kRed}) {
    if (text.compare(at, known.size(), known) == 0) return known.size();
  }
  return 0;
}

/// True if `stream` is a terminal that shows colours (the environment's TERM is set and is not
/// "dumb") and its user wants them (NO_COLOR is not set, or empty; see https://no-color.org).
/// Files and pipes never get colours.
bool shows_colours(std::FILE* stream) {
  const std::string_view terminal = variable("TERM");
  return variable("NO_COLOR").empty() && !terminal.empty() && terminal != "dumb" &&
         ::isatty(::fileno(stream)) != 0;
}

}  // namespace

std::string in_red(const std::string& text, std::FILE* stream) {
  return shows_colours(stream) ? std::string(kRed).append(text).append(kPlain) : text;
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

}  // namespace raymoval
