// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace raymoval {

/// Reads the members of a JSON object that users write, by name. A member that is missing keeps its
/// default. Every error is a ConfigurationError that names the place ("town.json: roads[0]"), the
/// key, and what was expected.
class ConfigObject {
 public:
  /// Unknown keys are errors that suggest the nearest of `keys`.
  /// @param json has to live as long as this object
  ConfigObject(const nlohmann::json& json, std::string where, const std::vector<std::string>& keys);

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] double number(const std::string& key, double fallback,
                              double low = -std::numeric_limits<double>::max(),
                              double high = std::numeric_limits<double>::max()) const;
  /// A finite number greater than 0.
  [[nodiscard]] double positive(const std::string& key, double fallback) const;
  [[nodiscard]] int integer(const std::string& key, int fallback, int low, int high) const;
  [[nodiscard]] bool flag(const std::string& key, bool fallback) const;
  [[nodiscard]] std::string text(const std::string& key, const std::string& fallback) const;
  /// A text that must be there and not be empty.
  [[nodiscard]] std::string text(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& key) const;
  /// The members of the list `key` with their places; none if it is missing.
  [[nodiscard]] std::vector<std::pair<const nlohmann::json*, std::string>> list(
      const std::string& key) const;
  /// The member `key`, which must be there.
  [[nodiscard]] const nlohmann::json& member(const std::string& key) const;

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] std::string place(const std::string& key) const { return where_ + ": " + key; }
  /// @throws ConfigurationError "WHERE: 'KEY' is 7, expected a text in quotes."
  [[noreturn]] void fail(const std::string& key, const std::string& expected) const;

 private:
  const nlohmann::json& json_;
  std::string where_;
};

}  // namespace raymoval
