// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace raymoval {

/// A file of benchmark/report/web as it was when the program was built: "page.css", "page.js",
/// "view.html", "view.js" (the bundled 3-D view) or "three_licence.txt". The last three are empty
/// if the program was built without the 3-D view.
std::string_view page_file(std::string_view name);

}  // namespace raymoval
