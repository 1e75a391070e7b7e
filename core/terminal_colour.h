// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

namespace raymoval {

/// `text` in red, the colour of errors, if `stream` shows colours; else `text`.
std::string in_red(const std::string& text, std::FILE* stream);

/// Untrusted `text` made safe for `stream`: line breaks and tabs stay, and the colour of
/// `in_red` if the stream shows it. Other control characters are replaced as by
/// `printable_text`.
std::string terminal_text(const std::string& text, std::FILE* stream);

/// Writes a line to standard error as `terminal_text`.
void print_error(const std::string& line);

/// Writes "raymoval: warning: LINE" to standard error as `terminal_text`.
void print_warning(const std::string& line);

}  // namespace raymoval
