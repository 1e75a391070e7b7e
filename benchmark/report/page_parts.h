// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// Whether the program was built with the 3-D view.
bool has_page_view();

/// All before <body>.
std::string head_html(const std::string& title);

/// @param with_view whether the page has the 3-D view, whose licence it then tells
std::string footer_html(bool with_view);

/// The scripts of a page, and what they read.
/// @param scenes the heads of `PackedScene`s; none: there is no view
/// @param streams those of all scenes
std::string scripts_html(const std::vector<std::string>& scenes,
                         const std::vector<std::pair<std::string, std::string>>& streams);

}  // namespace raymoval
