// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/parameters.h"
#include "methods/calibration.h"
#include "methods/remover.h"

namespace raymoval {

/// A named set of parameter values of a method.
struct MethodVariant {
  std::string name;
  std::string sentence = "";
  bool online = false;  ///< Scan t is answered from scans 0 .. t, or up to its `delay` later.
  Configuration overrides = {};  ///< Values that differ from the method's defaults.
  bool is_available = true;  ///< False if this build lacks a library for it, as `sentence` says.
};

/// Everything the rest of the program knows about a method.
struct MethodEntry {
  std::string name;
  std::string sentence;
  std::string source;              ///< The paper, or where else the method comes from.
  std::string bibtex = {};         ///< Of the paper; empty if there is none.
  std::string version = "1";       ///< It is raised whenever answers may change.
  std::vector<std::string> notes;  ///< Decisions and deviations from the source, a sentence each.
  std::vector<ParameterSpec> parameters;
  /// The parameters that `raymoval describe` shows unless all are asked for; empty: all.
  std::vector<std::string> main_parameters = {};
  std::string advice = {};  ///< What to change if too much or too little is removed, as sentences.
  std::vector<MethodVariant> variants;  ///< The first is what the bare name means.
  bool needs_truth = false;             ///< True for a control that is given the labels (`oracle`).
  Calibration confidence = {};  ///< Empty: the method gives no evidence (see `EvidenceSink`).
  std::string manifest = {};    ///< Path of the manifest of an external method.
  std::function<std::unique_ptr<Remover>(const Configuration&)> make;

  /// Takes the parameters from `table`; `make_remover` gets their values.
  template <class Parameters>
  void bind(const ParameterTable<Parameters>& table,
            std::unique_ptr<Remover> (*make_remover)(const Parameters&)) {
    parameters = table.specs();
    make = [table, make_remover](const Configuration& values) {
      return make_remover(table.read(values));
    };
  }
};

/// A method with its variant and every parameter's value: what a result is traced to.
struct ConfiguredMethod {
  const MethodEntry* entry = nullptr;
  MethodVariant variant;
  Configuration configuration;
  std::shared_ptr<const MethodEntry> owned = {};  ///< Holds `entry` if no registry does.

  /// Such as "raymoval:online".
  [[nodiscard]] std::string full_name() const { return entry->name + ":" + variant.name; }
  /// The text by which `MethodRegistry::configure` finds the method, in another process too.
  [[nodiscard]] std::string address() const {
    return entry->manifest.empty() ? full_name() : "external:" + entry->manifest;
  }
  [[nodiscard]] std::unique_ptr<Remover> make() const { return entry->make(configuration); }
  /// The parameters that have another value than in the variant, with the variant's value.
  [[nodiscard]] Configuration changed_from() const;
};

}  // namespace raymoval
