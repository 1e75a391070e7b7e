// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>

#include "benchmark/cli/command.h"
#include "benchmark/suite/shipped_suites.h"
#include "core/scan/sensor_model.h"
#include "core/text.h"
#include "datasets/layouts.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/scene_text.h"
#include "datasets/trajectories/pose_file.h"
#include "eval/columns/columns.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

using Lines = std::vector<std::pair<std::string, std::string>>;

Lines method_lines(bool variants) {
  Lines lines;
  for (const auto& entry : program_methods().entries()) {
    if (!variants) {
      lines.emplace_back(entry->name, entry->sentence);
      continue;
    }
    for (const MethodVariant& variant : entry->variants) {
      lines.emplace_back(entry->name + ":" + variant.name, variant.sentence);
    }
  }
  lines.emplace_back("external:MANIFEST",
                     "Your own program in any language, see docs/your-method.md.");
  return lines;
}

/// A line for each item of a list, which is a name or has one.
template <class List, class Sentence>
Lines lines_of(const List& list, Sentence sentence) {
  Lines lines;
  for (const auto& item : list) {
    if constexpr (requires { item.name; }) {
      lines.emplace_back(item.name, sentence(item));
    } else {
      lines.emplace_back(item, sentence(item));
    }
  }
  return lines;
}

Lines sensor_lines() {
  Lines lines = lines_of(sensor_model_names(), [](const std::string&) { return ""; });
  lines.emplace_back("estimated", "field of view and angular steps estimated from the scans");
  return lines;
}

std::string scene_sentence(const std::string& name) {
  const simulated::WorldFile world = simulated::parse_world(simulated::find_world(name));
  return world.description + " (" + grouped_text(static_cast<std::uint64_t>(world.scans)) +
         " scans, " + world.sensor + ")";
}

std::string simulated_sensor_sentence(const std::string& name) {
  return simulated::parse_sensor(simulated::find_sensor(name)).description;
}

Lines sequence_lines() {
  Lines lines;
  for (const Layout& layout : layouts()) {
    lines.insert(lines.end(), layout.forms.begin(), layout.forms.end());
  }
  return lines;
}

Lines column_lines() {
  Lines lines = lines_of(general_columns(), [](const Column& column) {
    const bool higher = column.better == Better::kHigher;
    return column.description + (higher ? " (higher is better)" : " (lower is better)");
  });
  lines.emplace_back("rejection [CLASS, BAND]", "For each moving class that occurs.");
  lines.emplace_back("preservation [CLASS, BAND]", "For each static class that occurs.");
  return lines;
}

void print_lines(const std::string& heading, const Lines& lines) {
  std::size_t width = 0;
  for (const auto& [name, sentence] : lines) width = std::max(width, name.size());
  std::string text = heading.empty() ? "" : heading + ":\n";
  for (const auto& [name, sentence] : lines) {
    text += (heading.empty() ? "" : "  ") + name;
    if (!sentence.empty()) text += std::string(width - name.size() + 2, ' ') + sentence;
    text += "\n";
  }
  print(text);
}

ExitCode list(const std::string& what) {
  const auto sentence_of = [](const auto& item) { return item.sentence; };
  const std::vector<std::pair<std::string, std::function<Lines()>>> lists = {
      {"methods", [] { return method_lines(false); }},
      {"variants", [] { return method_lines(true); }},
      {"protocols", [&] { return lines_of(protocol_entries(), sentence_of); }},
      {"columns", column_lines},
      {"sensors", sensor_lines},
      {"sequences", sequence_lines},
      {"pose-formats", [&] { return lines_of(pose_format_names(), sentence_of); }},
      {"scenes", [] { return lines_of(simulated_scene_names(), scene_sentence); }},
      {"simulated-sensors",
       [] { return lines_of(simulated_sensor_names(), simulated_sensor_sentence); }},
      {"suites", [] { return lines_of(shipped_suite_names(), suite_sentence); }}};
  std::vector<std::string> names;
  bool found = false;
  for (const auto& [name, make] : lists) {
    names.push_back(name);
    if (!what.empty() && what != name) continue;
    print_lines(what.empty() ? name : "", make());
    found = true;
  }
  if (!found) throw UsageError("there is no list of '" + what + "'." + suggestion(what, names));
  return ExitCode::kDone;
}

}  // namespace

Command add_list_command(CommandParser& program) {
  auto what = std::make_shared<std::string>();
  CommandOptions options =
      program.add_command("list", "Lists methods, protocols, sensors, scenes, suites");
  options.add("what", "WHAT", *what,
              "methods, variants, protocols, columns, sensors, sequences, pose-formats, scenes, "
              "simulated-sensors or suites; all if empty");
  options.set_footer("Examples:\n  raymoval list\n  raymoval list variants");
  return {options.name(), [what] { return list(*what); }};
}

}  // namespace raymoval
