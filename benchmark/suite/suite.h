// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/parameters.h"
#include "datasets/sequence.h"
#include "eval/rate.h"
#include "methods/registry.h"

namespace raymoval {

/// A sequence that a suite asks for.
struct SequenceRequest {
  std::string path;
  SequenceOptions options;
};

/// A method of a suite: the rows of cells it fills are called `name`.
struct MethodRequest {
  std::string name;  ///< Unique in the suite: "raymoval:online", or what "as" says.
  ConfiguredMethod method;
  std::string sweep_of = {};  ///< Name without the swept values, if this is one point of a sweep.
  Configuration sweep = {};   ///< The swept values of this point.
  std::vector<std::string> given = {};  ///< Parameters that somebody set, swept ones included.
};

/// A protocol of a suite with its effective options.
struct ProtocolRequest {
  std::string name;      ///< Unique in the suite: "erasor", or what "as" says.
  std::string protocol;  ///< Name for `make_protocol`.
  Configuration options;
};

/// Name of a suite that has none: its sequences and methods were named one by one. A suite file
/// that gives this name counts as one without.
inline constexpr const char* kUnnamedSuite = "run";

/// What one run does: every sequence with every method, scored by every protocol.
struct Suite {
  std::string name = kUnnamedSuite;
  std::vector<SequenceRequest> sequences;
  std::vector<MethodRequest> methods;
  std::vector<ProtocolRequest> protocols;
  bool controls = true;           ///< Whether the controls are added and checked.
  int threads = 0;                ///< 0: as many as the machine has.
  int repeats = 1;                ///< How often each method runs, for its time; controls run once.
  double time_limit_s = 0.0;      ///< Of a cell; 0: the usual, by the number of scans.
  double memory_limit_mib = 0.0;  ///< Of a cell; 0: the usual, by what the machine has.
};

/// `--set raymoval:online.tau0=0.2`, taken apart.
struct Setting {
  /// Method ("raymoval"), method and variant, cell name, or protocol ("protocol:erasor").
  std::string target;
  std::string key;
  std::string value;
};

/// @throws UsageError saying what the form is.
Setting parse_setting(const std::string& text);

/// Reads a suite file (JSON with comments). Relative paths are looked up beside the suite file
/// first, then from the working folder; "{data}" at the start of a path stands for `data`.
/// @throws ConfigurationError naming the file, the key and the nearest legal one; UsageError if the
/// file asks for `data` and there is none, or the other way round
Suite read_suite(const std::filesystem::path& path, const MethodRegistry& registry,
                 const std::string& data = "");

/// Adds "raymoval:online" under its own name, or under `as` if that is not empty.
/// @throws UsageError if the name is taken or unknown.
MethodRequest& add_method(Suite& suite, const std::string& name_and_variant, const std::string& as,
                          const MethodRegistry& registry);

/// Names of methods with their variants: "all" stands for the default variant of each method of the
/// registry but the controls, "raymoval:all" for all variants of one. Anything else is itself.
/// @throws UsageError if there is no such method
std::vector<std::string> expanded_methods(const std::string& name, const MethodRegistry& registry);

/// Options of a protocol. @throws UsageError suggesting the nearest protocol
const std::vector<ParameterSpec>& protocol_parameters(const std::string& name);

/// Adds a protocol with its default options. @throws UsageError if the name is taken or unknown.
ProtocolRequest& add_protocol(Suite& suite, const std::string& protocol, const std::string& as);

/// Applies settings: those for protocols, those for a method to all its variants, then those that
/// name a cell.
/// @throws UsageError if one names nothing of the suite, or the same value is set twice.
void apply_settings(Suite& suite, const std::vector<Setting>& settings);

/// A sentence for each parameter that was set for a method but has no effect there, see
/// `without_effect`. A swept one counts if it has none at any point of the sweep.
std::vector<std::string> settings_without_effect(const Suite& suite);

/// Sets an option of the protocol that `setting` names, with or without "protocol:" before it.
/// @throws UsageError if it is not among `protocols`, ConfigurationError for a key or value
void set_protocol_option(std::vector<ProtocolRequest>& protocols, const Setting& setting);

/// Puts `noop`, `remove-all` and `oracle` in front, unless listed already.
void add_controls(Suite& suite, const MethodRegistry& registry);

/// Names of the controls that `add_controls` knows.
const std::vector<std::string>& control_names();
bool is_control(const std::string& method);

/// Folder name of a cell: ':' becomes '-', and what a file system may not like becomes '_'.
std::string folder_name(const std::string& name);

/// What a control answers; nothing if `method` is no control.
std::optional<KnownAnswer> known_answer(const std::string& method);

}  // namespace raymoval
