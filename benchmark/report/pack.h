// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// `bytes` as a zlib stream.
std::string deflated(std::string_view bytes);

/// `bytes` as text for a <script> element: 13 bits, the lowest first, in two of 91 characters. This
/// takes 8 % less room than base64. Up to six bits at the end have one character.
std::string printable(std::string_view bytes);

/// JSON for a <script> element. No text in it can end the element.
std::string script_json(const nlohmann::ordered_json& json);

/// The data of the page's script: the heads of all scenes.
/// @param heads see `PackedScene`
std::string page_data(const std::vector<std::string>& heads);

}  // namespace raymoval
