// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// The meaning of a colour. The text has the same meaning without colour.
enum class TerminalColour {
  kGood,    ///< Green: done, better.
  kBad,     ///< Red: an error, failed, worse.
  kNotice,  ///< Yellow: not comparable, worth a look.
};

/// True if `stream` is a terminal that shows colours (the environment's TERM is set and is not
/// "dumb") and its user wants them (NO_COLOR is not set, or empty; see https://no-color.org).
/// Files and pipes never get colours.
bool shows_colours(std::FILE* stream);

/// `text` in a colour if `stream` shows colours, else `text`.
std::string coloured(const std::string& text, TerminalColour colour, std::FILE* stream);

/// Untrusted `text` made safe for `stream`: line breaks and tabs stay, and the colours of
/// `coloured` if the stream shows them. Other control characters are replaced as by
/// `printable_text`.
std::string terminal_text(const std::string& text, std::FILE* stream);

/// Writes a line to standard error as `terminal_text`.
void print_error(const std::string& line);

/// Writes "raymoval: warning: LINE" to standard error as `terminal_text`.
void print_warning(const std::string& line);

/// `text` with each phrase coloured where a line begins with "phrase:" or ends with "phrase.".
std::string coloured_phrases(const std::string& text,
                             const std::vector<std::pair<std::string, TerminalColour>>& phrases,
                             std::FILE* stream);

}  // namespace raymoval
