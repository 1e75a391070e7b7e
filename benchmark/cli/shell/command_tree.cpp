// SPDX-License-Identifier: MIT
#include "benchmark/cli/shell/command_tree.h"

#include <algorithm>
#include <array>

#include "benchmark/suite/shipped_suites.h"
#include "core/scan/sensor_model.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/simulation/scene/simulated.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

using Words = std::vector<std::string>;

Words method_words(const MethodRegistry& methods) {
  Words words;
  for (const auto& entry : methods.entries()) {
    words.push_back(entry->name);
    for (const MethodVariant& variant : entry->variants) {
      words.push_back(entry->name + ":" + variant.name);
    }
  }
  words.emplace_back("external:");
  return words;
}

/// What `run` and `plan` take: `all` for each method's first variant, `NAME:all` for all of one.
Words words_of_methods_to_run(const MethodRegistry& methods) {
  Words words = method_words(methods);
  words.emplace_back("all");
  for (const auto& entry : methods.entries()) words.push_back(entry->name + ":all");
  return words;
}

/// Suites, and the scenes that may stand in their place.
Words suite_words() {
  Words words = shipped_suite_names();
  const Words scenes = scene_names();
  words.insert(words.end(), scenes.begin(), scenes.end());
  return words;
}

void add_keys(const std::string& owner, const std::vector<ParameterSpec>& specs, Words& words) {
  for (const ParameterSpec& spec : specs) words.push_back(owner + "." + spec.name + "=");
}

Words setting_words(const MethodRegistry& methods) {
  Words words;
  for (const auto& entry : methods.entries()) add_keys(entry->name, entry->parameters, words);
  for (const ProtocolEntry& entry : protocol_entries()) {
    add_keys("protocol:" + entry.name, entry.parameters, words);
  }
  return words;
}

Words protocol_words() {
  Words words;
  for (const ProtocolEntry& entry : protocol_entries()) words.push_back(entry.name);
  return words;
}

/// What `describe` describes.
Words described_words(const MethodRegistry& methods) {
  Words words = method_words(methods);
  for (const std::string& name : protocol_words()) words.push_back("protocol:" + name);
  return words;
}

std::vector<ValueSet> common_values(const MethodRegistry& methods) {
  return {{.name = "none"},
          {.name = "files", .files = true},
          {.name = "folders", .folders = true},
          {.name = "methods", .words = method_words(methods)},
          {.name = "methods_to_run", .words = words_of_methods_to_run(methods)},
          {.name = "described", .words = described_words(methods)},
          {.name = "settings", .words = setting_words(methods), .goes_on = true},
          {.name = "protocols", .words = protocol_words()},
          {.name = "sequences", .words = scene_names(), .folders = true},
          {.name = "scenes", .words = simulated_scene_names(), .files = true},
          {.name = "suites", .words = suite_words(), .files = true},
          {.name = "sensors", .words = sensor_model_names()},
          {.name = "simulated_sensors", .words = simulated_sensor_names(), .files = true}};
}

/// The set for an option of which --help says that its value is a `type`; empty: its sentence names
/// the values.
std::string set_of_type(const std::string& command, const std::string& option,
                        const std::string& type) {
  static const std::array<std::array<const char*, 2>, 14> by_type = {{{"FILE", "files"},
                                                                      {"SUBMISSION", "files"},
                                                                      {"DIR", "folders"},
                                                                      {"FOLDER", "folders"},
                                                                      {"RUN", "folders"},
                                                                      {"ROOT", "folders"},
                                                                      {"REFERENCE", "folders"},
                                                                      {"PATH", "sequences"},
                                                                      {"SCENE", "scenes"},
                                                                      {"SUITE", "suites"},
                                                                      {"SETTING", "settings"},
                                                                      {"KIND", ""},
                                                                      {"FORMAT", ""},
                                                                      {"WHAT", ""}}};
  for (const auto& [name, set] : by_type) {
    if (type == name) return set;
  }
  if (type == "LAYOUT" || type == "SHELL") return "";
  if (type == "COMMAND") return "commands";
  if (type != "NAME") return "none";
  if (command == "describe") return "described";
  const bool runs = command == "run" || command == "plan";
  if (option == "--method") return runs ? "methods_to_run" : "methods";
  if (option == "--protocol") return "protocols";
  if (option == "--sensor") return command == "simulate" ? "simulated_sensors" : "sensors";
  return option == "--sequence" ? "sequences" : "none";
}

/// A set of the words of `sentence`, found by its name in `values`.
std::string set_of_sentence(const std::string& command, const OptionText& option,
                            std::vector<ValueSet>& values) {
  const Words words = words_named_first(option.sentence);
  if (words.size() < 2) return "none";
  std::string name =
      command + "_" + (option.long_name.empty() ? "word" : option.long_name.substr(2));
  std::replace(name.begin(), name.end(), '-', '_');
  values.push_back({.name = name, .words = words});
  return name;
}

void name_value_sets(CommandText& command, std::vector<ValueSet>& values) {
  for (std::vector<OptionText>* texts : {&command.options, &command.words}) {
    for (OptionText& option : *texts) {
      if (option.value.empty()) continue;  // A flag.
      option.value_set = set_of_type(command.name, option.long_name, option.value);
      if (option.value_set.empty()) {
        option.value_set = set_of_sentence(command.name, option, values);
      }
    }
  }
}

bool is_word(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') || letter == '-';
  });
}

}  // namespace

std::vector<std::string> words_named_first(const std::string& sentence) {
  Words words;
  const std::string first = sentence.substr(0, sentence.find_first_of(";:."));
  for (const std::string_view piece : split(first, ',')) {
    for (const std::string_view part : split_blanks(piece)) {
      if (part == "or" || part == "(default)") continue;
      if (!is_word(std::string(part))) return words;
      words.emplace_back(part);
    }
  }
  return words;
}

CommandTree command_tree(const CommandParser& program, const MethodRegistry& methods) {
  CommandTree tree;
  tree.values = common_values(methods);
  tree.program = program.program_text();
  tree.commands = program.command_texts();
  name_value_sets(tree.program, tree.values);
  ValueSet names{.name = "commands"};
  for (CommandText& command : tree.commands) {
    name_value_sets(command, tree.values);
    names.words.push_back(command.name);
  }
  tree.values.push_back(names);
  return tree;
}

}  // namespace raymoval
