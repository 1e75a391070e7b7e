// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace raymoval {

/// The form of a name of a sequence, method, protocol or suite, for messages.
inline constexpr const char* kNameForm =
    "1 to 200 bytes of UTF-8 without slashes, control or invisible characters, with no blank at "
    "either end, that do not begin with one of . - = + @";

/// Says what is wrong with a name of a sequence, method, protocol or suite. Empty if it may stand.
///
/// Names come from folders, sequence.json, suites and other people's results, and go into folders,
/// options, terminals, CSV, Markdown, LaTeX and HTML. What no escape of these makes harmless is no
/// name: a spreadsheet takes what begins with = + - @ for a formula, a shell an initial - for an
/// option, a terminal obeys control characters, and invisible ones or a change of the direction of
/// writing show one name as another.
std::string name_problem(const std::string& name);

}  // namespace raymoval
