// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "benchmark/tables/text/text_table.h"

namespace raymoval {

/// Text for an HTML page, also within quotes. Bytes that are not UTF-8 are replaced.
std::string html_text(const std::string& text);

/// The same for a name. A line may be broken after ':', '_', '/', '=' and ','.
std::string html_name(const std::string& name);

enum class TableHeight { kWhole, kScrolled };

/// An accessible table with a caption. Its heading cells have a scope, and a click on the heading
/// of a column sorts by it (web/page.js). The best value is bold and the second one underlined.
/// Summary rows stay at the bottom.
std::string html_table(const TextTable& table, TableHeight height = TableHeight::kWhole);

/// A table of lost shares in percent. The larger a value, the darker its background.
std::string html_heat_table(const TextTable& table);

/// A part of the page with its heading.
struct PageSection {
  std::string id, title, html;
};

std::string html_section(const PageSection& section);

/// A <ul> of plain texts.
std::string html_list(const std::vector<std::string>& lines);

}  // namespace raymoval
