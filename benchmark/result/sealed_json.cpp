// SPDX-License-Identifier: MIT
#include "benchmark/result/sealed_json.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/strict_json.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

std::string checksum_of(const ordered_json& json) {
  return content_hash(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

/// Null if `text` is no JSON.
ordered_json parsed(const std::string& text, const std::filesystem::path& path) {
  try {
    return parse_ordered_json(text, path.string());
  } catch (const ConfigurationError&) {
    return nullptr;
  }
}

}  // namespace

std::string json_text(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void write_sealed(const std::filesystem::path& path, ordered_json json) {
  json.erase("checksum");
  json["checksum"] = checksum_of(json);
  write_atomically(path, json_text(json));
}

ordered_json read_sealed(const std::filesystem::path& path) {
  const std::string remedy = " Run `raymoval run` again with the same --out to rewrite it.";
  ordered_json json = parsed(read_text(path), path);
  if (!json.is_object() || !json.contains("checksum") || !json["checksum"].is_string()) {
    throw DataError(path.string() +
                    ": not a whole result file of raymoval (JSON object with a "
                    "\"checksum\")." +
                    remedy);
  }
  const std::string stored = json["checksum"].get<std::string>();
  json.erase("checksum");
  if (stored != checksum_of(json)) {
    throw DataError(path.string() +
                    ": the content does not fit its checksum; it was changed or "
                    "damaged after it was written." +
                    remedy);
  }
  return json;
}

}  // namespace raymoval
