// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/parameters.h"
#include "datasets/sequence.h"
#include "eval/rate.h"
#include "methods/registry.h"

namespace raymoval {

/// A sequence of a suite.
struct SequenceRequest {
  std::string path;
  SequenceOptions options;
};

/// The same place with absolute paths, for use from another folder. Scenes keep their names.
SequenceRequest absolute_place(const SequenceRequest& place);

/// A method of a suite. Its cells have its `name`.
struct MethodRequest {
  /// Unique in the suite: "raymoval:online", "raymoval:online*" if a parameter differs from the
  /// variant, or the value of "as".
  std::string name;
  ConfiguredMethod method;
  std::string sweep_of = {};  ///< Name without the swept values, if this is one point of a sweep.
  Configuration sweep = {};   ///< The swept values of this point.
  std::vector<std::string> given = {};  ///< Explicitly set parameters, also swept ones.

  /// The parameters that differ from the variant, with the variant's value; without swept ones.
  [[nodiscard]] Configuration changed_from() const;
};

/// A protocol of a suite with its effective options.
struct ProtocolRequest {
  std::string name;      ///< Unique in the suite: "erasor", or the value of "as".
  std::string protocol;  ///< Name for `make_protocol`.
  Configuration options;
};

/// The name of a suite without a suite file. A suite file that gives this name counts as one
/// without a name.
inline constexpr const char* kUnnamedSuite = "run";

/// The work of one run: every sequence with every method, scored by every protocol.
struct Suite {
  std::string name = kUnnamedSuite;
  std::vector<SequenceRequest> sequences;
  std::vector<MethodRequest> methods;
  std::vector<ProtocolRequest> protocols;
  bool controls = true;           ///< Whether the controls are added and checked.
  int threads = 0;                ///< 0 means all threads of the machine.
  double time_limit_s = 0.0;      ///< Of a cell; 0 means the usual limit for its number of scans.
  double memory_limit_mib = 0.0;  ///< Of a cell; 0 means the usual limit of the machine.
};

/// The parts of `--set raymoval:online.tau1=0.2`.
struct Setting {
  /// Method ("raymoval"), method and variant, cell name, or protocol ("protocol:erasor").
  std::string target;
  std::string key;
  std::string value;
};

/// @throws UsageError that names the form
Setting parse_setting(const std::string& text);

/// Reads a suite file (JSON with comments). Relative paths are looked up beside the suite file
/// first, then from the working folder; "{data}" at the start of a path is replaced by `data`.
/// @throws ConfigurationError naming the file, the key and the nearest valid key; UsageError if the
/// file needs `data` and there is none, or the reverse
Suite read_suite(const std::filesystem::path& path, const MethodRegistry& registry,
                 const std::string& data = "");

/// Adds a method such as "raymoval:online" under its own name, or under `as` if that is not empty.
/// @throws UsageError if the name is taken or unknown
MethodRequest& add_method(Suite& suite, const std::string& name_and_variant, const std::string& as,
                          const MethodRegistry& registry);

/// Adds a method with its parameters. If one of them differs from the variant, the name gets a '*'.
/// @throws UsageError if the name is taken
void add_request(Suite& suite, MethodRequest request);

/// The methods that a name selects, with their variants: "all" for the default variant of each
/// method of the registry but the controls, "raymoval:all" for all variants of one method, and any
/// other name for itself.
/// @throws UsageError if there is no such method
std::vector<std::string> expanded_methods(const std::string& name, const MethodRegistry& registry);

/// Adds a protocol with its default options. @throws UsageError if the name is taken or unknown.
ProtocolRequest& add_protocol(Suite& suite, const std::string& protocol, const std::string& as);

/// Applies settings: first those for protocols, then those for all variants of a method, then those
/// that name a cell. A method whose parameters now differ from its variant gets a '*' behind its
/// name.
/// @throws UsageError if a target is not in the suite, or the same value is set twice;
/// ConfigurationError if a method's values do not fit together, whether set here or by the suite
void apply_settings(Suite& suite, const std::vector<Setting>& settings);

/// A sentence for each parameter that was set for a method but has no effect there (see
/// `without_effect`). A swept parameter has a sentence if it has no effect at any point of the
/// sweep.
std::vector<std::string> settings_without_effect(const Suite& suite);

/// Sets an option of the protocol that `setting` names, with or without "protocol:" before it.
/// @throws UsageError if the protocol is not among `protocols`, ConfigurationError for a bad key or
/// value
void set_protocol_option(std::vector<ProtocolRequest>& protocols, const Setting& setting);

/// Puts the controls `noop`, `remove-all` and `oracle` first, unless the suite already lists them.
void add_controls(Suite& suite, const MethodRegistry& registry);

/// Whether `add_controls` adds this method.
bool is_control(const std::string& method);

/// The name of a cell's folder: ':' becomes '-', and characters that some file systems reject
/// become '_'.
std::string folder_name(const std::string& name);

/// The known answer of a control; no value if `method` is no control.
std::optional<KnownAnswer> known_answer(const std::string& method);

}  // namespace raymoval
