// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace raymoval {

/// `bytes` as a zlib stream.
std::string deflated(std::string_view bytes);

/// `bytes` in base64, with padding.
std::string base64(std::string_view bytes);

}  // namespace raymoval
