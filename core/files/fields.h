// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace raymoval {

/// Two numbers with low <= high.
struct NumberRange {
  double low = 0.0;
  double high = 0.0;
};

/// Reads the members of a JSON object that users write, by name. A member that is missing keeps its
/// default. Every error is a ConfigurationError that names the place ("town.json: roads[0]"), the
/// key and what was expected.
class Fields {
 public:
  /// @param json must outlive this object
  /// @param keys the legal keys, separated by blanks. Any other key is an error that suggests the
  /// nearest legal key.
  Fields(const nlohmann::json& json, std::string where, std::string_view keys);

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] bool is_number(const std::string& key) const;
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
  /// Text that must be one of `choices`.
  [[nodiscard]] std::string choice(const std::string& key, const std::string& fallback,
                                   const std::vector<std::string>& choices) const;
  /// [low, high], or one number for both; both within `lowest` and `highest`.
  [[nodiscard]] NumberRange interval(const std::string& key, NumberRange fallback,
                                     double lowest = -std::numeric_limits<double>::max(),
                                     double highest = std::numeric_limits<double>::max()) const;
  [[nodiscard]] std::vector<double> numbers(const std::string& key) const;
  /// [[a, b], ...]
  [[nodiscard]] std::vector<std::pair<double, double>> pairs(const std::string& key) const;
  /// The same as places, at most `reach` metres from the origin along each axis.
  [[nodiscard]] std::vector<Eigen::Vector2d> points(const std::string& key, double reach) const;
  /// Members of the list `key` with their places; empty if it is missing.
  [[nodiscard]] std::vector<std::pair<const nlohmann::json*, std::string>> list(
      const std::string& key) const;
  /// Member `key`, which must be there.
  [[nodiscard]] const nlohmann::json& member(const std::string& key) const;
  /// Names of all members, sorted.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] std::string place(const std::string& key) const { return where_ + ": " + key; }
  [[noreturn]] void fail(const std::string& key, const std::string& expected) const;

 private:
  const nlohmann::json& json_;
  std::string where_;
};

}  // namespace raymoval
