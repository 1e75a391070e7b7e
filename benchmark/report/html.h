// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "benchmark/tables/text_table.h"

namespace raymoval {

/// Text for an HTML page, also within quotes; what is not UTF-8 is replaced.
std::string html_text(const std::string& text);

/// The same for a name, which may be broken into lines behind ':', '_', '/', '=' and ','.
std::string html_name(const std::string& name);

/// Text for an id: letters, digits and '-'.
std::string html_id(const std::string& text);

/// JSON for a <script> element, which nothing in its texts ends.
std::string script_json(const nlohmann::ordered_json& json);

enum class TableHeight { kWhole, kScrolled };

/// An accessible table with a caption: its heading cells have a scope, those of columns can be
/// sorted by (web/page.js), the best value is bold, the second underlined, summary rows stay below.
std::string html_table(const TextTable& table, TableHeight height = TableHeight::kWhole);

/// A table of what is lost: values in percent, with a ground that grows with them.
std::string html_heat_table(const TextTable& table);

/// A part of the page with its heading.
struct PageSection {
  std::string id, title, html;
};

std::string html_section(const PageSection& section);

/// <ul> of plain texts.
std::string html_list(const std::vector<std::string>& lines);

}  // namespace raymoval
