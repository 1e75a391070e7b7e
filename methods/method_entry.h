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
  bool online = false;           ///< The mask of scan t uses scans up to t, or up to a delay later.
  Configuration overrides = {};  ///< Values that differ from the method's defaults.
  /// The data on which its rules or numbers were chosen, for footnotes of tables; empty: not known.
  std::string developed_on = {};
  bool is_available = true;  ///< False if this build lacks a library for it, as `sentence` says.
};

/// The description of a method for the rest of the program.
struct MethodEntry {
  std::string name;
  std::string sentence;
  std::string source;              ///< The paper, or another source of the method.
  std::string bibtex = {};         ///< Of the paper; empty if there is none.
  std::string version = "1";       ///< Raised whenever results may change.
  std::vector<std::string> notes;  ///< Decisions and deviations from the source, a sentence each.
  std::vector<ParameterSpec> parameters;
  /// The parameters that `raymoval describe` shows by default; empty: all.
  std::vector<std::string> main_parameters = {};
  std::string advice = {};              ///< Sentences on too much or too little removal.
  std::vector<MethodVariant> variants;  ///< The first is the default.
  bool needs_truth = false;             ///< True for a control that uses the labels (`oracle`).
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

/// A method with its variant and every parameter's value: the origin of a result.
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
  /// The parameters that differ from the variant, with the variant's value.
  [[nodiscard]] Configuration changed_from() const;
};

}  // namespace raymoval
