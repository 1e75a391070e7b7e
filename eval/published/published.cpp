// SPDX-License-Identifier: MIT
#include "eval/published/published.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

using Json = nlohmann::json;

/// The rates of all protocols, and what papers print of times.
std::vector<std::string> number_names() {
  std::vector<std::string> names;
  for (const RateSpec& spec : rate_specs()) {
    if (spec.role != RateRole::kSecondary) names.push_back(spec.name);
  }
  names.insert(names.end(), {"milliseconds_per_scan", "share", "seconds_per_scan"});
  return names;
}

const std::vector<std::string> kTexts = {"method", "sequence", "stage", "poses", "reported_by"};

[[noreturn]] void fail(const std::string& where, const std::string& expected) {
  throw ConfigurationError(where + ": expected " + expected +
                           ". The published tables in results/published/ show the form.");
}

std::string text_of(const Json& json, const std::string& where) {
  if (!json.is_string()) fail(where, "a text");
  return json.get<std::string>();
}

double number_of(const Json& json, const std::string& where) {
  if (!json.is_number()) fail(where, "a number");
  return json.get<double>();
}

const Json& member(const Json& json, const std::string& key, const std::string& where) {
  if (!json.contains(key)) fail(where, "the key '" + key + "'");
  return json.at(key);
}

std::string optional_text(const Json& json, const std::string& key, const std::string& where) {
  return json.contains(key) ? text_of(json.at(key), where + "." + key) : std::string{};
}

/// Reads the list `key` of `json` item by item. The result is empty if there is no such key.
template <class Item, class Read>
std::vector<Item> read_list(const Json& json, const std::string& key, const std::string& where,
                            Read&& read) {
  std::vector<Item> items;
  if (!json.contains(key)) return items;
  const Json& list = json.at(key);
  if (!list.is_array()) fail(where + "." + key, "a list");
  for (std::size_t i = 0; i < list.size(); ++i) {
    items.push_back(read(list[i], where + "." + key + "[" + std::to_string(i) + "]"));
  }
  return items;
}

PublishedRow read_row(const Json& json, const std::string& where) {
  const std::vector<std::string> numbers = number_names();
  std::vector<std::string> allowed = kTexts;
  allowed.insert(allowed.end(), numbers.begin(), numbers.end());
  check_keys(json, allowed, where);
  PublishedRow row;
  row.method = text_of(member(json, "method", where), where + ".method");
  row.sequence = optional_text(json, "sequence", where);
  row.stage = optional_text(json, "stage", where);
  row.poses = optional_text(json, "poses", where);
  row.reported_by = optional_text(json, "reported_by", where);
  for (const std::string& name : numbers) {
    if (!json.contains(name)) continue;
    const Json& value = json.at(name);
    row.values[name] =
        value.is_null() ? std::nullopt : std::optional(number_of(value, where + "." + name));
  }
  if (row.values.empty()) fail(where, "at least one number, such as " + join(numbers));
  return row;
}

Misprint read_misprint(const Json& json, const std::string& where) {
  check_keys(json, {"method", "metric", "printed", "recomputed"}, where);
  return {text_of(member(json, "method", where), where + ".method"),
          text_of(member(json, "metric", where), where + ".metric"),
          number_of(member(json, "printed", where), where + ".printed"),
          number_of(member(json, "recomputed", where), where + ".recomputed")};
}

std::map<std::string, std::string> read_units(const Json& json, const std::string& where) {
  check_keys(json, number_names(), where);
  std::map<std::string, std::string> units;
  for (const auto& [name, unit] : json.items()) units[name] = text_of(unit, where + "." + name);
  return units;
}

void check_units(const PublishedTable& table, const std::string& where) {
  for (const PublishedRow& row : table.rows) {
    for (const auto& [name, value] : row.values) {
      if (!table.units.contains(name)) fail(where + ".units", "a unit for '" + name + "'");
    }
  }
}

}  // namespace

std::optional<double> PublishedRow::value(const std::string& name) const {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : found->second;
}

PublishedTable load_published_table(const std::filesystem::path& path) {
  const Json json = read_json(path);
  const std::string where = path.string();
  check_keys(json,
             {"table", "source", "protocol", "units", "rows", "averages_printed",
              "averages_computed", "totals_printed", "misprints", "notes"},
             where);
  PublishedTable table;
  table.table = text_of(member(json, "table", where), where + ".table");
  table.source = text_of(member(json, "source", where), where + ".source");
  table.protocol = text_of(member(json, "protocol", where), where + ".protocol");
  table.units = read_units(member(json, "units", where), where + ".units");
  member(json, "rows", where);
  table.rows = read_list<PublishedRow>(json, "rows", where, read_row);
  if (table.rows.empty()) fail(where + ".rows", "at least one row");
  table.averages_printed = read_list<PublishedRow>(json, "averages_printed", where, read_row);
  table.averages_computed = read_list<PublishedRow>(json, "averages_computed", where, read_row);
  table.totals_printed = read_list<PublishedRow>(json, "totals_printed", where, read_row);
  table.misprints = read_list<Misprint>(json, "misprints", where, read_misprint);
  table.notes = read_list<std::string>(json, "notes", where, text_of);
  check_units(table, where);
  return table;
}

}  // namespace raymoval
