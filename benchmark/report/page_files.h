// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace raymoval {

/// A file of benchmark/report/web as it was when the program was built, such as "page.css".
std::string_view page_file(std::string_view name);

}  // namespace raymoval
