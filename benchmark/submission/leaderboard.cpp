// SPDX-License-Identifier: MIT
#include "benchmark/submission/leaderboard.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/parameters.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// A method of one table.
struct Entry {
  const Verification* verification = nullptr;
  const ProtocolResult* result = nullptr;
  std::optional<double> headline = {};
};

/// The rates that stand in tables, the headline rate among them.
std::vector<RateSpec> shown_rates(const std::string& protocol) {
  std::vector<RateSpec> shown;
  for (const RateSpec& rate : protocol_entry(protocol).rates) {
    if (rate.role != RateRole::kSecondary) shown.push_back(rate);
  }
  return shown;
}

const RateSpec* headline_of(const std::vector<RateSpec>& rates) {
  for (const RateSpec& rate : rates) {
    if (rate.role == RateRole::kHeadline) return &rate;
  }
  return nullptr;
}

/// By how much `a` is better than `b`, in the direction of the rate.
Interval advantage(const Entry& a, const Entry& b, const RateSpec& rate) {
  if (!a.result->intervals || !b.result->intervals) return {rate.name, {}, {}, "no intervals"};
  const Entry& more = rate.higher_is_better ? a : b;
  const Entry& less = rate.higher_is_better ? b : a;
  return paired_difference(*more.result->intervals, *less.result->intervals, rate.name);
}

bool is_beyond(const Interval& interval) {
  return interval.low && *interval.low > 0.0;
}

/// What stands in tables: what holds and is no control.
bool is_ranked(const Verification& verification) {
  return verification.verdict() == SubmissionVerdict::kHolds &&
         !verification.submitted.cell.method.control;
}

/// What `verification` scores by `protocol`, whichever of its protocols that is; null if it was not
/// scored by it.
const ProtocolResult* result_by(const Verification& verification, const ProtocolRecord& protocol) {
  const std::vector<Score>& scores = verification.submitted.cell.scores;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (same_scoring(scores[i].protocol, protocol)) return &verification.scores.protocols[i];
  }
  return nullptr;
}

/// Whether a table of one before `one`, or of its protocol before number `i`, has protocol number
/// `i` on the same data.
bool is_told(const std::vector<Verification>& verified, const Verification& one, std::size_t i) {
  const ProtocolRecord& protocol = one.submitted.cell.scores[i].protocol;
  for (const Verification& before : verified) {
    if (&before == &one) break;
    if (!is_ranked(before) || !same_data(before.submitted.cell, one.submitted.cell)) continue;
    if (result_by(before, protocol) != nullptr) return true;
  }
  return result_by(one, protocol) != &one.scores.protocols[i];
}

/// The entries on the data of `first` by `protocol`, the best first.
std::vector<Entry> entries_like(const std::vector<Verification>& verified,
                                const Verification& first, const ProtocolRecord& protocol,
                                const RateSpec& rate) {
  std::vector<Entry> entries;
  for (const Verification& one : verified) {
    if (!is_ranked(one) || !same_data(one.submitted.cell, first.submitted.cell)) continue;
    const ProtocolResult* result = result_by(one, protocol);
    if (result != nullptr) entries.push_back({&one, result, result->rate(rate.name)});
  }
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    if (!a.headline || !b.headline) return a.headline.has_value() && !b.headline;
    return rate.is_better(*a.headline, *b.headline);
  });
  return entries;
}

std::string interval_text(const Interval& interval, const RateSpec& rate) {
  if (!interval.low || !interval.high) return "n/a";
  return fixed_text(*interval.low, rate.decimals) + " to " +
         fixed_text(*interval.high, rate.decimals);
}

std::string own_interval(const Entry& entry, const RateSpec& rate) {
  if (!entry.result->intervals) return "n/a";
  for (const Interval& interval : entry.result->intervals->rates) {
    if (interval.name == rate.name) return interval_text(interval, rate);
  }
  return "n/a";
}

/// What is known of the distance to the first method.
std::string distance_text(const Entry& first, const Entry& entry, const RateSpec& rate) {
  if (&first == &entry) return "-";
  const Interval interval = advantage(first, entry, rate);
  if (!interval.low) return "n/a";
  return interval_text(interval, rate) + (is_beyond(interval) ? "" : ": not told apart");
}

/// Those of `rates` that any of the entries has.
std::vector<RateSpec> rates_in(const std::vector<Entry>& entries, std::vector<RateSpec> rates) {
  std::erase_if(rates, [&](const RateSpec& rate) {
    return std::none_of(entries.begin(), entries.end(), [&](const Entry& entry) {
      return entry.result->rate(rate.name).has_value();
    });
  });
  return rates;
}

TableRow row_of(const std::vector<Entry>& entries, std::size_t place,
                const std::vector<RateSpec>& rates, const RateSpec& headline) {
  const Entry& entry = entries[place];
  const SubmittedCell& submitted = entry.verification->submitted;
  std::size_t rank = 1;
  for (std::size_t i = 0; i < place; ++i) {
    if (is_beyond(advantage(entries[i], entry, headline))) ++rank;
  }
  TableRow row{submitted.cell.name,
               {{submitted.cell.method.version}, {submitted.from}, {std::to_string(rank)}}};
  for (const RateSpec& rate : rates) {
    const auto value = entry.result->rate(rate.name);
    row.cells.push_back({value ? fixed_text(*value, rate.decimals) : "n/a"});
  }
  row.cells.push_back({own_interval(entry, headline)});
  row.cells.push_back({distance_text(entries.front(), entry, headline)});
  return row;
}

/// "05 by protocol erasor", with the options that are not at their defaults.
std::string title_of(const Cell& cell, const ProtocolRecord& protocol) {
  std::string title = fmt::format("{} by protocol {}", cell.sequence, protocol.name);
  const Configuration defaults = protocol_defaults(protocol.protocol);
  for (const auto& option : protocol.options) {
    if (std::find(defaults.begin(), defaults.end(), option) != defaults.end()) continue;
    title += fmt::format(", {} = {}", option.first, parameter_text(option.second));
  }
  return title;
}

TextTable table_of(const std::vector<Entry>& entries, const ProtocolRecord& protocol,
                   const std::vector<RateSpec>& rates, const RateSpec& headline) {
  const Cell& cell = entries.front().verification->submitted.cell;
  TextTable table{
      title_of(cell, protocol), "method", {{"", {"version", "submission", "rank"}}}, {}, {}};
  std::vector<std::string>& columns = table.groups[0].columns;
  for (const RateSpec& rate : rates) columns.push_back(rate.name);
  columns.push_back(headline.name + ", 95 %");
  columns.push_back("below the first, 95 %");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    table.rows.push_back(row_of(entries, i, rates, headline));
  }
  table.notes.push_back(fmt::format(
      "{} scans, data {}, protocol {} version {}. Masks were scored again for every row.",
      cell.data->scans, cell.data->fingerprint, protocol.protocol, protocol.version));
  table.notes.push_back(fmt::format(
      "A rank is one more than the number of methods whose {} is better beyond the interval of the "
      "difference, by block bootstrap over the same scans. Methods that are not told apart may "
      "share a rank.",
      headline.name));
  return table;
}

}  // namespace

std::vector<TextTable> leaderboard(const std::vector<Verification>& verified) {
  std::vector<TextTable> tables;
  for (const Verification& one : verified) {
    if (!is_ranked(one)) continue;
    const std::vector<Score>& scores = one.submitted.cell.scores;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      const ProtocolRecord& protocol = scores[i].protocol;
      const std::vector<RateSpec> all = shown_rates(protocol.protocol);
      const RateSpec* headline = headline_of(all);
      if (headline == nullptr || is_told(verified, one, i)) continue;
      const std::vector<Entry> entries = entries_like(verified, one, protocol, *headline);
      tables.push_back(table_of(entries, protocol, rates_in(entries, all), *headline));
    }
  }
  return tables;
}

}  // namespace raymoval
