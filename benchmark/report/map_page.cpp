// SPDX-License-Identifier: MIT
#include "benchmark/report/map_page.h"

#include "benchmark/report/html.h"
#include "benchmark/report/page_files.h"
#include "benchmark/report/page_parts.h"

namespace raymoval {

std::string map_page(const Scene& scene, const std::string& title,
                     const std::vector<std::string>& lines) {
  const PackedScene packed = pack_scene(scene, 0);
  return head_html(title) +
         "<body>\n<a class=\"skip\" href=\"#main\">To the content</a>\n<header><h1>" +
         html_name(title) + "</h1>\n<button type=\"button\" id=\"theme\">Dark</button></header>\n" +
         "<main id=\"main\">\n" +
         html_section({"points", "Map",
                       std::string(page_file("view.html")) +
                           "<noscript><p>The 3-D view needs JavaScript.</p>"
                           "</noscript>\n"}) +
         html_section({"facts", "What was done", html_list(lines)}) + "</main>\n" +
         footer_html(true) + scripts_html({packed.head}, packed.streams) + "</body>\n</html>\n";
}

}  // namespace raymoval
