// SPDX-License-Identifier: MIT
#include "benchmark/tables/table_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr int kMostDecimals = 9;

/// All rates of all rows, the usual ones first.
std::vector<std::string> known_rates(const RunResults& results) {
  std::vector<std::string> known;
  for (const std::string& protocol : results.protocols) {
    for (const std::string& rate : results.rates_of(protocol)) add_once(known, rate);
  }
  for (const Cell& cell : results.cells) {
    for (const std::string& protocol : results.protocols) {
      std::set<std::string> names;
      if (const Score* score = cell.score(protocol)) {
        for (const Rate& rate : score->rates) names.insert(rate.name);
      }
      for (const std::string& name : names) add_once(known, name);
    }
  }
  return known;
}

}  // namespace

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (!is_among(names, name)) names.push_back(name);
}

TableCell rate_cell(const TableOptions& options, const std::string& rate, double value,
                    int printed) {
  const auto own = options.decimals_of.find(rate);
  std::optional<int> wanted = options.decimals;
  if (own != options.decimals_of.end()) wanted = own->second;
  if (printed > 0) return number_cell(value, std::min(printed, wanted.value_or(printed)));
  return number_cell(value, wanted.value_or(rate_spec(rate).decimals));
}

TableCell mean_cell(const TableOptions& options, const std::string& rate, const Mean& mean,
                    std::size_t of, int printed) {
  if (!mean.value) return {"n/a"};
  TableCell cell = rate_cell(options, rate, *mean.value, printed);
  if (mean.segments != of) cell.text += fmt::format(" ({}/{})", mean.segments, of);
  return cell;
}

std::string rate_units_text(const std::vector<std::string>& rates) {
  std::vector<std::string> fractions, lower;
  for (const std::string& rate : rates) {
    const RateSpec spec = rate_spec(rate);
    if (spec.unit == RateUnit::kFraction) add_once(fractions, rate);
    if (!spec.higher_is_better) add_once(lower, rate);
  }
  std::string text = "Rates in percent";
  if (!fractions.empty()) text += ", " + join(fractions, " and ") + " as a fraction";
  if (!lower.empty()) text += "; lower is better for " + join(lower, " and ");
  return text + ".";
}

std::vector<std::string> chosen_rates(const TableOptions& options, const RunResults& results,
                                      const std::string& protocol) {
  if (options.rates.empty()) return results.rates_of(protocol);
  std::vector<std::string> rates;
  for (const std::string& rate : options.rates) {
    if (results.gives(protocol, rate)) rates.push_back(rate);
  }
  return rates;
}

bool shows_time(const TableOptions& options) {
  return is_among(options.rates, kTimeRate);
}

void check_rates(const TableOptions& options, const RunResults& results) {
  std::vector<std::string> known = known_rates(results);
  known.emplace_back(kTimeRate);
  const auto check = [&](const std::string& option, const std::string& rate) {
    if (is_among(known, rate)) return;
    throw UsageError(option + " " + rate + ": no protocol of this run gives such a rate." +
                     suggestion(rate, known));
  };
  for (const std::string& rate : options.rates) check("--rates", rate);
  for (const auto& [rate, decimals] : options.decimals_of) check("--decimals", rate);
  known.insert(known.end(), {kMemoryColumn, "name", "none"});
  check("--sort", options.sort);
}

std::vector<std::string> methods_sorted_by(const RunResults& results,
                                           const std::vector<std::string>& sequences,
                                           const std::string& column) {
  std::vector<std::string> methods = results.methods;
  if (column == "name") std::ranges::sort(methods);
  std::map<std::string, double> goodness;
  for (const std::string& method : methods) {
    std::optional<double> cost;
    if (column == kTimeRate) cost = results.ms_per_scan(method);
    if (column == kMemoryColumn) cost = results.peak_mib(method);
    if (cost) goodness[method] = -*cost;
    for (const std::string& protocol : results.protocols) {
      if (!results.gives(protocol, column)) continue;
      SegmentValues values;
      for (const std::string& sequence : sequences) {
        values.push_back(results.rate(sequence, method, protocol, column));
      }
      const auto mean = mean_cell({}, column, mean_of(values), sequences.size()).value;
      if (mean) goodness[method] = rate_spec(column).higher_is_better ? *mean : -*mean;
      break;
    }
  }
  std::ranges::stable_sort(methods, [&](const std::string& a, const std::string& b) {
    const auto left = goodness.find(a), right = goodness.find(b);
    if (right == goodness.end()) return left != goodness.end();
    return left != goodness.end() && left->second > right->second;
  });
  return methods;
}

std::vector<std::string> methods_best_first(const RunResults& results) {
  if (results.protocols.empty()) return results.methods;
  return methods_sorted_by(results, results.sequences,
                           results.headline_of(results.protocols.front()));
}

void sort_results(const std::string& column, RunResults& results) {
  if (column == "none") return;
  const auto by_place_in = [](const std::vector<std::string>& order, auto member) {
    return [&order, member](const auto& a, const auto& b) {
      return std::ranges::find(order, a.*member) < std::ranges::find(order, b.*member);
    };
  };
  for (const std::string& sequence : results.sequences) {
    const auto order = methods_sorted_by(results, {sequence}, column);
    const auto own = std::ranges::stable_partition(
        results.cells, [&](const Cell& cell) { return cell.sequence != sequence; });
    std::ranges::stable_sort(own, by_place_in(order, &Cell::name));
  }
  results.methods = methods_sorted_by(results, results.sequences, column);
  std::ranges::stable_sort(results.columns, by_place_in(results.methods, &MethodColumns::cell));
  std::ranges::stable_sort(results.times, by_place_in(results.methods, &MethodTimes::cell));
  std::ranges::stable_sort(results.reliability,
                           by_place_in(results.methods, &MethodReliability::cell));
}

void parse_decimals(const std::string& text, TableOptions& options) {
  const std::size_t equals = text.find('=');
  const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
  const auto decimals = parse_number<int>(number);
  if (equals == 0 || !decimals || *decimals < 0 || *decimals > kMostDecimals) {
    throw UsageError("--decimals " + text + ": expected a number of digits from 0 to " +
                     std::to_string(kMostDecimals) + ", or one for a rate, such as F1=3.");
  }
  if (equals == std::string::npos) {
    options.decimals = decimals;
  } else {
    options.decimals_of[text.substr(0, equals)] = *decimals;
  }
}

}  // namespace raymoval
