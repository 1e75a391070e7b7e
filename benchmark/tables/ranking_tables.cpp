// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>

#include "benchmark/tables/tables.h"
#include "core/text.h"
#include "eval/averages.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// A score by which methods are ranked: one protocol on one sequence, or the mean over all.
struct Ranking {
  std::string protocol;
  std::string rate;
  SegmentValues scores;                           ///< Of each method, as displayed.
  std::vector<std::optional<std::size_t>> ranks;  ///< From 1; methods that tie share one.
};

/// @param sequences one, or all for the mean; a method that misses one of them has no rank
Ranking ranking_of(const RunResults& results, const std::vector<std::string>& sequences,
                   const std::vector<std::string>& methods, const std::string& protocol) {
  Ranking ranking{protocol, results.headline_of(protocol), {}, {}};
  const RateSpec spec = rate_spec(ranking.rate);
  for (const std::string& method : methods) {
    SegmentValues values;
    for (const std::string& sequence : sequences) {
      values.push_back(results.rate(sequence, method, protocol, ranking.rate));
    }
    const Mean mean = mean_of(values);
    const bool whole = mean.value && mean.segments == sequences.size();
    ranking.scores.push_back(whole ? number_cell(*mean.value, spec.decimals).value : std::nullopt);
  }
  for (const auto& score : ranking.scores) {
    const auto better = std::count_if(
        ranking.scores.begin(), ranking.scores.end(),
        [&](const auto& other) { return other && score && spec.is_better(*other, *score); });
    ranking.ranks.push_back(score ? std::optional(static_cast<std::size_t>(better) + 1)
                                  : std::nullopt);
  }
  return ranking;
}

/// "+2" for two places up, "=" for none; the largest move from the first ranking to any other.
std::string change_text(const std::vector<Ranking>& rankings, std::size_t method) {
  std::ptrdiff_t largest = 0;
  bool known = false;
  const auto& first = rankings.front().ranks[method];
  for (std::size_t i = 1; i < rankings.size(); ++i) {
    const auto& other = rankings[i].ranks[method];
    if (!first || !other) continue;
    known = true;
    const auto move = static_cast<std::ptrdiff_t>(*first) - static_cast<std::ptrdiff_t>(*other);
    if (std::abs(move) > std::abs(largest)) largest = move;
  }
  if (!known) return "-";
  if (largest == 0) return "=";
  return (largest > 0 ? "+" : "") + std::to_string(largest);
}

/// "a before b by F1 (erasor), after it by HA (dynamicmap)" for each pair that changes places.
std::vector<std::string> swaps(const std::vector<Ranking>& rankings,
                               const std::vector<std::string>& methods) {
  std::vector<std::string> texts;
  const Ranking& first = rankings.front();
  const auto by = [](const Ranking& ranking) {
    return "by " + ranking.rate + " (" + ranking.protocol + ")";
  };
  const auto before = [](const Ranking& ranking, std::size_t a, std::size_t b) {
    return ranking.ranks[a] && ranking.ranks[b] && *ranking.ranks[a] < *ranking.ranks[b];
  };
  for (std::size_t a = 0; a < methods.size(); ++a) {
    for (std::size_t b = 0; b < methods.size(); ++b) {
      for (std::size_t i = 1; i < rankings.size(); ++i) {
        if (!before(first, a, b) || !before(rankings[i], b, a)) continue;
        texts.push_back(methods[a] + " before " + methods[b] + " " + by(first) + ", after it " +
                        by(rankings[i]));
      }
    }
  }
  return texts;
}

std::vector<std::string> ranked_methods(const RunResults& results) {
  std::vector<std::string> methods;
  for (const std::string& method : results.methods) {
    const bool ranked = std::ranges::any_of(results.cells, [&](const Cell& cell) {
      return cell.name == method && !cell.method.control;
    });
    if (ranked) methods.push_back(method);
  }
  return methods;
}

/// Adds a block of ranks, and, if requested, notes on the pairs of methods that change places.
void add_ranks(const RunResults& results, const std::vector<std::string>& sequences,
               const std::string& heading, bool name_pairs, TextTable& table) {
  const std::vector<std::string> methods = ranked_methods(results);
  std::vector<Ranking> rankings;
  for (const std::string& protocol : results.protocols) {
    rankings.push_back(ranking_of(results, sequences, methods, protocol));
  }
  table.groups = {{"", {}}};
  for (const Ranking& ranking : rankings) {
    table.groups[0].columns.push_back(ranking.protocol + " " + ranking.rate);
  }
  table.groups[0].columns.push_back("change");
  for (std::size_t method = 0; method < methods.size(); ++method) {
    TableRow& row = table.rows.emplace_back(TableRow{methods[method], {}, false, heading});
    for (const Ranking& ranking : rankings) {
      const auto& rank = ranking.ranks[method];
      row.cells.push_back({rank ? std::to_string(*rank) : "-"});
    }
    row.cells.push_back({change_text(rankings, method)});
  }
  if (!name_pairs) return;
  for (const std::string& swap : swaps(rankings, methods)) {
    table.notes.push_back(heading + ": " + swap + ".");
  }
}

}  // namespace

std::vector<TextTable> ranking_tables(const RunResults& results, const TableOptions& options) {
  if (results.protocols.size() < 2 || ranked_methods(results).size() < 2) return {};
  TextTable table{"Ranking by protocol", "method"};
  table.notes.push_back(
      "Ranks; equal displayed values share a rank. change: places gained (+) or lost from the "
      "first protocol to the one where most are; -: not in all sequences. Differences within the "
      "intervals are no ranking.");
  const bool several = results.sequences.size() > 1;
  if (!several || options.disagreements) {
    for (const std::string& sequence : results.sequences) {
      add_ranks(results, {sequence}, sequence, options.disagreements, table);
    }
  }
  if (several) {
    add_ranks(results, results.sequences, "mean over the sequences", options.disagreements, table);
  }
  if (options.disagreements && table.notes.size() == 1) {
    table.notes.push_back("No pair of methods changes places.");
  }
  return {table};
}

}  // namespace raymoval
