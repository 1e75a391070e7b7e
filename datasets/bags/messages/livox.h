// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace raymoval {

/// Whether `type` is the message that Livox's drivers publish points in.
bool is_livox(const std::string& type);

}  // namespace raymoval
