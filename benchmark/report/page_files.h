// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace raymoval {

/// A file of benchmark/report/web as it was when the program was built: "page.css", "page.js",
/// "view.html", "view.js", the bundled 3-D view, and "LICENSE", that of three.js. Empty if the
/// program was built without it.
std::string_view page_file(std::string_view name);

}  // namespace raymoval
