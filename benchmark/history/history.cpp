// SPDX-License-Identifier: MIT
#include "benchmark/history/history.h"

#include <fmt/format.h>

#include <algorithm>

namespace raymoval {
namespace {

const RecordedScore* score_like(const HistoryLine& line, const RecordedScore& wanted) {
  for (const RecordedScore& score : line.scores) {
    if (score.protocol == wanted.protocol) return &score;
  }
  return nullptr;
}

std::optional<double> rate_of(const RecordedScore& score, const std::string& name) {
  for (const auto& [rate, value] : score.rates) {
    if (rate == name) return value;
  }
  return std::nullopt;
}

void compare_scores(const RecordedScore& before, const RecordedScore& after, HistoryEvent& event) {
  if (before.version != after.version) {
    event.changes.push_back(
        fmt::format("protocol {} version {} to {}", after.protocol, before.version, after.version));
  }
  std::size_t others = 0;
  for (const auto& [name, value] : after.counts) {
    for (const auto& [known, was] : before.counts) others += known == name && was != value ? 1 : 0;
  }
  if (others == 0) return;
  event.changes.push_back(fmt::format("counts of {}", after.protocol));
  for (const auto& [name, value] : after.rates) {
    const auto was = rate_of(before, name);
    if (value && was && *value != *was) event.moved.emplace_back(name, *value - *was);
  }
}

void compare_speed(const HistoryEvent& before, double band, HistoryEvent& event) {
  const auto &was = before.line.speed, &is = event.line.speed;
  if (!was || !is || was->yardstick != is->yardstick) return;
  if (!(was->median > 0.0) || !(is->median > 0.0)) return;
  const double ratio = is->median / was->median;
  // Rounds that overlap say nothing: the machine was busy.
  if (is->least <= was->most && was->least <= is->most) return;
  if (ratio > band) event.changes.push_back(fmt::format("{:.2f} times slower", ratio));
  if (ratio < 1.0 / band) event.changes.push_back(fmt::format("{:.2f} times faster", 1.0 / ratio));
}

/// @param timed the last event with a time, or null
HistoryEvent event_after(const HistoryEvent& last, const HistoryEvent* timed,
                         const HistoryLine& line, double band) {
  HistoryEvent event{line};
  const HistoryLine& before = last.line;
  const auto note = [&](const char* what, const std::string& was, const std::string& is) {
    if (was != is) event.changes.push_back(fmt::format("{} {} to {}", what, was, is));
  };
  if (before.fingerprint != line.fingerprint) event.changes.emplace_back("the scene is another");
  note("status", before.status, line.status);
  note("method version", before.method_version, line.method_version);
  for (const RecordedScore& score : line.scores) {
    const RecordedScore* known = score_like(before, score);
    if (known != nullptr) compare_scores(*known, score, event);
  }
  const bool counted = std::any_of(event.changes.begin(), event.changes.end(),
                                   [](const auto& text) { return text.starts_with("counts"); });
  if (before.masks != line.masks && !counted && !before.masks.empty() && !line.masks.empty()) {
    event.changes.emplace_back("masks, with the same counts");
  }
  if (timed != nullptr) compare_speed(*timed, band, event);
  return event;
}

HistoryTrack& track_of(std::vector<HistoryTrack>& tracks, const HistoryLine& line) {
  for (HistoryTrack& track : tracks) {
    if (track.sequence == line.sequence && track.method == line.method &&
        track.machine == line.machine)
      return track;
  }
  tracks.push_back({line.sequence, line.method, line.machine});
  return tracks.back();
}

const HistoryEvent* last_timed(const HistoryTrack& track) {
  for (auto event = track.events.rbegin(); event != track.events.rend(); ++event) {
    if (event->line.speed) return &*event;
  }
  return nullptr;
}

}  // namespace

std::vector<HistoryTrack> history_tracks(const std::vector<HistoryLine>& lines, double band) {
  std::vector<HistoryTrack> tracks;
  for (const HistoryLine& line : lines) {
    HistoryTrack& track = track_of(tracks, line);
    if (track.events.empty()) {
      track.events.push_back({line, {}, true});
    } else {
      HistoryEvent event = event_after(track.events.back(), last_timed(track), line, band);
      track.events.push_back(std::move(event));
    }
  }
  return tracks;
}

}  // namespace raymoval
