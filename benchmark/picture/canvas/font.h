// SPDX-License-Identifier: MIT
#pragma once

struct _cairo;

namespace raymoval {

/// Makes `context` write in DejaVu Sans, from the file that $RAYMOVAL_FONT names or from where
/// systems keep it. A file is read once in a process. fontconfig is not asked: the same file
/// gives the same picture whatever else is installed.
/// @param size of the letters in pixels
/// @param bold by the file NAME-Bold.ttf beside NAME.ttf; without it, letters are not bold
/// @throws ConfigurationError if there is no such file, or if it is no font
void choose_font(_cairo* context, int size, bool bold = false);

}  // namespace raymoval
