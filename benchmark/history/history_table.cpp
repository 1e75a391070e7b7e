// SPDX-License-Identifier: MIT
#include "benchmark/history/history_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

/// The rates that tables show, of the protocols that a track was scored by.
std::vector<std::string> shown_rates(const std::vector<const HistoryTrack*>& tracks) {
  std::vector<std::string> shown;
  for (const RateSpec& rate : rate_specs()) {
    if (rate.role == RateRole::kSecondary || rate.role == RateRole::kMean) continue;
    const bool there = std::any_of(tracks.begin(), tracks.end(), [&](const HistoryTrack* track) {
      for (const HistoryEvent& event : track->events) {
        for (const RecordedScore& score : event.line.scores) {
          for (const auto& [name, value] : score.rates) {
            if (name == rate.name) return true;
          }
        }
      }
      return false;
    });
    if (there && std::find(shown.begin(), shown.end(), rate.name) == shown.end())
      shown.push_back(rate.name);
  }
  return shown;
}

std::string recorded_rate(const HistoryLine& line, const std::string& name) {
  for (const RecordedScore& score : line.scores) {
    for (const auto& [rate, value] : score.rates) {
      if (rate == name) return value ? rate_text(name, *value) : "n/a";
    }
  }
  return "";
}

/// "counts of erasor (F1 +0.0123)", or "first".
std::string changes_text(const HistoryEvent& event) {
  if (event.is_first) return "first";
  std::vector<std::string> parts = event.changes;
  std::vector<std::string> moved;
  for (const auto& [rate, by] : event.moved) {
    if (rate_spec(rate).role != RateRole::kHeadline) continue;
    moved.push_back(rate + (by < 0.0 ? " " : " +") + fixed_text(by, rate_spec(rate).decimals));
  }
  return join(parts) + (moved.empty() ? "" : " (" + join(moved) + ")");
}

TableRow row_of(const HistoryEvent& event, const std::vector<std::string>& rates, bool timed) {
  const HistoryLine& line = event.line;
  TableRow row{line.commit.substr(0, 9), {}, false, line.method};
  row.cells.push_back({line.date.substr(0, 10)});
  row.cells.push_back({line.version});
  row.cells.push_back({line.method_version});
  for (const std::string& rate : rates) row.cells.push_back({recorded_rate(line, rate)});
  if (timed) row.cells.push_back({line.speed ? fixed_text(line.speed->median, 2) : ""});
  row.cells.push_back({changes_text(event)});
  return row;
}

TextTable table_of(const std::vector<const HistoryTrack*>& tracks, double band, bool all) {
  const HistoryTrack& first = *tracks.front();
  TextTable table{first.sequence + " on " + first.machine, "commit", {{"", {}}}, {}, {}};
  const std::vector<std::string> rates = shown_rates(tracks);
  bool timed = false;
  for (const HistoryTrack* track : tracks) {
    for (const HistoryEvent& event : track->events) timed = timed || event.line.speed;
  }
  std::vector<std::string>& columns = table.groups[0].columns;
  columns = {"date", "program", "method"};
  columns.insert(columns.end(), rates.begin(), rates.end());
  if (timed) columns.emplace_back("yardsticks");
  columns.emplace_back("what changed");
  for (const HistoryTrack* track : tracks) {
    for (const HistoryEvent& event : track->events) {
      if (!all && !event.is_first && event.changes.empty()) continue;
      table.rows.push_back(row_of(event, rates, timed));
    }
  }
  if (timed) {
    table.notes.push_back(fmt::format(
        "A time counts as changed beyond a factor of {:g}. It is a multiple of the time "
        "of a fixed kernel that ran beside it.",
        band));
  }
  return table;
}

}  // namespace

std::vector<TextTable> history_tables(const std::vector<HistoryTrack>& tracks, double band,
                                      bool all) {
  std::vector<TextTable> tables;
  std::vector<std::pair<std::string, std::string>> done;
  for (const HistoryTrack& head : tracks) {
    const std::pair<std::string, std::string> place{head.sequence, head.machine};
    if (std::find(done.begin(), done.end(), place) != done.end()) continue;
    done.push_back(place);
    std::vector<const HistoryTrack*> same;
    for (const HistoryTrack& track : tracks) {
      if (track.sequence == head.sequence && track.machine == head.machine) same.push_back(&track);
    }
    tables.push_back(table_of(same, band, all));
  }
  return tables;
}

}  // namespace raymoval
