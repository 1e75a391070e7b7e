// SPDX-License-Identifier: MIT
#include "benchmark/report/page_parts.h"

#include "benchmark/picture/charts/charts.h"
#include "benchmark/report/html.h"
#include "benchmark/report/pack.h"
#include "benchmark/report/page_files.h"

namespace raymoval {

bool has_page_view() {
  return !page_file("view.js").empty();
}

std::string head_html(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"generator\" content=\"raymoval " RAYMOVAL_VERSION
         "\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         html_text(title) + "</title>\n<style>\n" + chart_style() +
         std::string(page_file("page.css")) + "</style>\n</head>\n";
}

std::string footer_html(bool with_view) {
  std::string html =
      "<footer><p>Made by raymoval " RAYMOVAL_VERSION ". This file needs no network.";
  if (with_view) {
    html += " Its 3-D view contains three.js " RAYMOVAL_THREE_VERSION
            ", under the MIT licence.</p>\n<details><summary>Licence of three.js</summary>\n<pre>" +
            html_text(std::string(page_file("three_licence.txt"))) + "</pre></details";
  } else {
    html += "</p";
  }
  return html + "></footer>\n";
}

std::string scripts_html(const std::vector<std::string>& scenes,
                         const std::vector<std::pair<std::string, std::string>>& streams) {
  std::string html = "<script>\n" + std::string(page_file("page.js")) + "</script>\n";
  if (scenes.empty()) return html;
  for (const auto& [id, text] : streams) {
    html += "<script type=\"application/octet-stream\" id=\"" + id + "\">" + text + "</script>\n";
  }
  html += "<script type=\"application/json\" id=\"scenes\">" + page_data(scenes) +
          "</script>\n<script>\n" + std::string(page_file("view.js")) + "</script>\n";
  return html;
}

}  // namespace raymoval
