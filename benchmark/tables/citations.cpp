// SPDX-License-Identifier: MIT
#include "benchmark/tables/citations.h"

#include <fmt/format.h>

#include "benchmark/process/machine.h"
#include "benchmark/suite/suite.h"
#include "benchmark/tables/table_options.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {

Citations::Citations(const MethodRegistry& methods) : methods_(methods) {
  add(
      fmt::format("@software{{raymoval,\n  author = {{{{The raymoval authors}}}},\n"
                  "  title = {{raymoval: evaluation and benchmarking of dynamic-object removal in "
                  "static LiDAR mapping}},\n  version = {{{}}}\n}}\n",
                  build_record().version));
}

void Citations::add(const std::string& entry) {
  if (!entry.empty()) add_once(entries_, entry);
}

void Citations::add_method(const MethodEntry& entry) {
  const bool is_ours = entry.source == "this project" || is_control(entry.name);
  const bool is_commented = entry.bibtex.empty() && !is_ours;
  add(is_commented ? "% " + entry.name + ": " + entry.source + "\n" : entry.bibtex);
}

void Citations::add_run(const RunRecord& run) {
  for (const SuiteMethodRecord& method : run.methods) {
    if (const MethodEntry* entry = known_method(method.method)) {
      add_method(*entry);
    } else {
      add("% " + method.method + ": this program does not know the method\n");
    }
  }
  for (const ProtocolRecord& protocol : run.protocols) {
    if (const ProtocolEntry* entry = find_protocol(protocol.protocol)) add(entry->bibtex);
  }
}

const MethodEntry* Citations::known_method(const std::string& full_name) const {
  const std::string name = full_name.substr(0, full_name.find(':'));
  for (const auto& entry : methods_.entries()) {
    if (entry->name == name) return entry.get();
  }
  return nullptr;
}

std::string Citations::text() const {
  return join(entries_, "\n");
}

}  // namespace raymoval
