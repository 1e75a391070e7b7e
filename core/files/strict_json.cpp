// SPDX-License-Identifier: MIT
#include "core/files/strict_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/error.h"

namespace raymoval {
namespace {

std::string place_text(const std::string& text, std::size_t byte) {
  const std::size_t at = std::min(byte > 0 ? byte - 1 : 0, text.size());
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
  const std::size_t line_start = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(at - line_start + 1);
}

/// Checks each part of a text while it is parsed.
template <class Json>
class Checker {
 public:
  Checker(const std::string& where, bool zero_bytes) : where_(where), zero_bytes_(zero_bytes) {}

  bool operator()(int depth, typename Json::parse_event_t event, const Json& value) {
    using Event = typename Json::parse_event_t;
    const bool starts = event == Event::object_start || event == Event::array_start;
    if (starts && depth >= kMostJsonDepth) {  // The outermost has depth 0.
      throw ConfigurationError(where_ + ": lists and objects are nested more than " +
                               std::to_string(kMostJsonDepth) + " deep.");
    }
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event == Event::key && !keys_.back().insert(value.template get<std::string>()).second) {
      throw ConfigurationError(where_ + ": the key " + value.dump() +
                               " occurs twice in one object; leave one out.");
    }
    const bool text = event == Event::key || (event == Event::value && value.is_string());
    if (text && !zero_bytes_ &&
        value.template get_ref<const std::string&>().find('\0') != std::string::npos) {
      throw ConfigurationError(where_ + ": the text " + value.dump() +
                               " has a zero byte, which no name or path has.");
    }
    return true;
  }

 private:
  const std::string& where_;
  bool zero_bytes_;
  std::vector<std::set<std::string>> keys_;
};

template <class Json>
Json parse(const std::string& text, const std::string& where, bool zero_bytes) {
  Checker<Json> checker(where, zero_bytes);
  try {
    return Json::parse(
        text, [&](int depth, auto event, Json& value) { return checker(depth, event, value); },
        true, /*ignore_comments=*/true);
  } catch (const typename Json::parse_error& error) {
    throw ConfigurationError(where + ": " + place_text(text, error.byte) +
                             ": not valid JSON (a comma or a quote is missing or surplus there).");
  } catch (const typename Json::out_of_range&) {
    throw ConfigurationError(where + ": holds a number that is too large; expected at most " +
                             "1.7e308.");
  }
}

}  // namespace

nlohmann::json parse_json(const std::string& text, const std::string& where) {
  return parse<nlohmann::json>(text, where, false);
}

nlohmann::ordered_json parse_ordered_json(const std::string& text, const std::string& where) {
  return parse<nlohmann::ordered_json>(text, where, true);
}

}  // namespace raymoval
