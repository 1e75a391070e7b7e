// SPDX-License-Identifier: MIT
#include "core/parameter_condition.h"

#include "core/text.h"

namespace raymoval {
namespace {

constexpr const char* kNever = "never";

/// The words of one condition with the place that is read next.
class Reader {
 public:
  Reader(const std::string& condition, const Configuration& configuration)
      : condition_(condition), configuration_(configuration), words_(split_blanks(condition)) {}

  bool any() {
    bool holds = all();
    while (take("or")) holds = all() || holds;
    if (next_ != words_.size()) fail("expected 'and' or 'or'");
    return holds;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InternalError("condition '" + condition_ + "': " + what);
  }
  bool take(std::string_view word) {
    if (next_ == words_.size() || words_[next_] != word) return false;
    ++next_;
    return true;
  }
  std::string word() {
    if (next_ == words_.size()) fail("ends too early");
    return std::string(words_[next_++]);
  }

  bool all() {
    bool holds = comparison();
    while (take("and")) holds = comparison() && holds;
    return holds;
  }

  bool comparison() {
    const ParameterValue& value = value_of(word());
    if (take("is")) {
      const bool negated = take("not");
      return (parameter_text(value) == word()) != negated;
    }
    const std::string relation = word();
    const double left = number_of(parameter_text(value)), right = number_of(word());
    if (relation == ">") return left > right;
    if (relation == "<") return left < right;
    if (relation == ">=") return left >= right;
    if (relation == "<=") return left <= right;
    fail("no comparison '" + relation + "'");
  }

  [[nodiscard]] const ParameterValue& value_of(const std::string& name) const {
    for (const auto& [key, value] : configuration_) {
      if (key == name) return value;
    }
    fail("no parameter '" + name + "'");
  }
  [[nodiscard]] double number_of(const std::string& text) const {
    const auto number = parse_number<double>(text);
    if (!number) fail("'" + text + "' is not a number");
    return *number;
  }

  const std::string& condition_;
  const Configuration& configuration_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

}  // namespace

bool condition_holds(const std::string& condition, const Configuration& configuration) {
  if (condition == kNever) return false;
  return condition.empty() || Reader(condition, configuration).any();
}

bool has_effect(const ParameterSpec& spec, const Configuration& configuration) {
  return condition_holds(spec.notes.acts_when, configuration);
}

std::string effect_text(const ParameterSpec& spec) {
  if (spec.notes.acts_when == kNever) return "it changes time or memory only";
  return "it acts when " + spec.notes.acts_when;
}

std::vector<std::string> without_effect(const std::string& owner,
                                        const std::vector<ParameterSpec>& specs,
                                        const Configuration& configuration,
                                        const std::vector<std::string>& names) {
  std::vector<std::string> lines;
  for (const std::string& name : names) {
    const ParameterSpec& spec = find_parameter(owner, specs, name);
    if (has_effect(spec, configuration)) continue;
    lines.push_back(owner + "." + name + " has no effect here: " + effect_text(spec) + ".");
  }
  return lines;
}

}  // namespace raymoval
