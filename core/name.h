// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace raymoval {

/// The form of a name of a sequence, method, protocol or suite, for messages.
inline constexpr const char* kNameForm =
    "1 to 200 bytes of UTF-8 without slashes, control or invisible characters, with no blank at "
    "either end, that do not begin with one of . - = + @";

/// The fault of a name of a sequence, method, protocol or suite; empty if the name is legal.
///
/// Names come from folders, sequence.json, suites and other people's results, and go into folders,
/// options, terminals, CSV, Markdown, LaTeX and HTML. A name is illegal if no escape makes it
/// harmless. A spreadsheet reads text that begins with = + - @ as a formula, and a shell reads an
/// initial - as an option. A terminal executes control characters. Invisible characters or a change
/// of the direction of writing show one name as another.
std::string name_problem(const std::string& name);

}  // namespace raymoval
