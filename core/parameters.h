// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"

namespace raymoval {

using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;

/// All parameters of a method with their values, in the order of their table.
using Configuration = std::vector<std::pair<std::string, ParameterValue>>;

/// The description of a parameter, without name, type and default.
struct ParameterNotes {
  std::string unit = "";  ///< "m", "rad", "points"; empty for a ratio or a flag.
  double minimum = -std::numeric_limits<double>::infinity();  ///< Legal range, ends included.
  double maximum = std::numeric_limits<double>::infinity();
  std::string source = "";    ///< Paper, section, equation or table; "" = our own choice.
  std::string sentence = "";  ///< The effect in one sentence.
  /// When the parameter has an effect, such as "erase is true and erase_height > 0"; "" = always,
  /// "never" = it changes time or memory only. See core/parameter_condition.h.
  std::string acts_when = "";
};

struct ParameterSpec {
  std::string name;
  ParameterValue default_value;
  ParameterNotes notes;
  std::vector<std::string> choices;  ///< For a text parameter: the legal values.
};

/// `value` as plain text ("0.3", "true", "naive").
std::string parameter_text(const ParameterValue& value);

/// Reads `json` as a value of `spec`.
/// @throws ConfigurationError naming `owner`, the key, the legal type or range.
ParameterValue checked_value(const std::string& owner, const ParameterSpec& spec,
                             const nlohmann::json& json);

/// Reads text from a command line ("0.3", "true", "naive") as a value of `spec`.
ParameterValue checked_value_from_text(const std::string& owner, const ParameterSpec& spec,
                                       const std::string& text);

/// The spec called `name`. @throws ConfigurationError suggesting the nearest legal name.
const ParameterSpec& find_parameter(const std::string& owner,
                                    const std::vector<ParameterSpec>& specs,
                                    const std::string& name);

/// Puts `value` in the place of the parameter called `name`.
void set_parameter(Configuration& configuration, const std::string& name, ParameterValue value);

/// JSON object in table order.
nlohmann::ordered_json to_json(const Configuration& configuration);

/// The one place where a method's parameters are named: binds members of the plain struct
/// `Parameters` to names, units, ranges, sources and a sentence each. Reading, checking, describing
/// and saving all come from it. Defaults are those of a default-constructed `Parameters`.
template <class Parameters>
class ParameterTable {
 public:
  ParameterTable& number(const std::string& name, double Parameters::*member,
                         const ParameterNotes& notes) {
    return bind<double>(name, member, notes, {});
  }
  ParameterTable& integer(const std::string& name, int Parameters::*member,
                          const ParameterNotes& notes) {
    return bind<std::int64_t>(name, member, notes, {});
  }
  ParameterTable& flag(const std::string& name, bool Parameters::*member,
                       const ParameterNotes& notes) {
    return bind<bool>(name, member, notes, {});
  }
  /// An enumeration, written as one of `names`.
  template <class Enum>
  ParameterTable& choice(const std::string& name, Enum Parameters::*member,
                         const std::vector<std::pair<std::string, Enum>>& names,
                         const ParameterNotes& notes) {
    std::vector<std::string> choices;
    for (const auto& [text, value] : names) choices.push_back(text);
    const auto text_of = [names](Enum wanted) {
      for (const auto& [text, value] : names) {
        if (value == wanted) return text;
      }
      throw InternalError("an enumeration value has no name");
    };
    const auto set = [member, names](Parameters& p, const ParameterValue& wanted) {
      for (const auto& [text, value] : names) {
        if (text == std::get<std::string>(wanted)) p.*member = value;
      }
    };
    const auto get = [member, text_of](const Parameters& p) { return text_of(p.*member); };
    add({name, get(Parameters{}), notes, choices}, set, get);
    return *this;
  }

  [[nodiscard]] const std::vector<ParameterSpec>& specs() const { return specs_; }

  [[nodiscard]] Configuration write(const Parameters& parameters) const {
    Configuration configuration;
    for (std::size_t i = 0; i < specs_.size(); ++i) {
      configuration.emplace_back(specs_[i].name, getters_[i](parameters));
    }
    return configuration;
  }

  [[nodiscard]] Parameters read(const Configuration& configuration) const {
    Parameters parameters;
    for (const auto& [name, value] : configuration) {
      for (std::size_t i = 0; i < specs_.size(); ++i) {
        if (specs_[i].name == name) setters_[i](parameters, value);
      }
    }
    return parameters;
  }

 private:
  using Setter = std::function<void(Parameters&, const ParameterValue&)>;
  using Getter = std::function<ParameterValue(const Parameters&)>;

  template <class Stored, class Member>
  ParameterTable& bind(const std::string& name, Member Parameters::*member,
                       const ParameterNotes& notes, const std::vector<std::string>& choices) {
    const auto set = [member](Parameters& p, const ParameterValue& value) {
      p.*member = static_cast<Member>(std::get<Stored>(value));
    };
    const auto get = [member](const Parameters& p) -> ParameterValue {
      return static_cast<Stored>(p.*member);
    };
    add({name, get(Parameters{}), notes, choices}, set, get);
    return *this;
  }
  void add(ParameterSpec spec, Setter set, Getter get) {
    specs_.push_back(std::move(spec));
    setters_.push_back(std::move(set));
    getters_.push_back(std::move(get));
  }

  std::vector<ParameterSpec> specs_;
  std::vector<Setter> setters_;
  std::vector<Getter> getters_;
};

}  // namespace raymoval
