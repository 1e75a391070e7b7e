// SPDX-License-Identifier: MIT
#include "benchmark/submission/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/result/removals/removal_files.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

using Differences = std::vector<std::string>;

const std::string& key_of(const std::pair<std::string, std::int64_t>& count) {
  return count.first;
}

template <class Named>
const std::string& key_of(const Named& named) {
  return named.name;
}

/// Compares two lists by name: `compare` gets what both have, and what only one has is told.
/// @param where stands before each line, "erasor"
/// @param what the items are, "count"
template <class Item, class Compare>
void compare_lists(const std::string& where, const std::string& what, const std::vector<Item>& said,
                   const std::vector<Item>& found, Differences& differences, Compare compare) {
  const auto called = [](const std::vector<Item>& items, const std::string& name) {
    return std::find_if(items.begin(), items.end(),
                        [&](const Item& item) { return key_of(item) == name; });
  };
  for (const Item& theirs : said) {
    const auto ours = called(found, key_of(theirs));
    if (ours != found.end()) {
      compare(theirs, *ours);
    } else {
      differences.push_back(fmt::format("{}: there is no {} {}", where, what, key_of(theirs)));
    }
  }
  for (const Item& ours : found) {
    if (called(said, key_of(ours)) != said.end()) continue;
    differences.push_back(
        fmt::format("{}: the submission lacks the {} {}", where, what, key_of(ours)));
  }
}

void compare_counts(const Score& said, const ProtocolResult& found, Differences& differences) {
  const std::string& where = said.protocol.name;
  compare_lists(where, "count", said.counts, found.counts, differences,
                [&](const auto& theirs, const auto& ours) {
                  if (theirs.second == ours.second) return;
                  differences.push_back(fmt::format("{}: {} is {}, the submission says {}", where,
                                                    ours.first, ours.second, theirs.second));
                });
}

std::string number_or_none(const std::optional<double>& value) {
  return value ? number_text(*value) : "undefined";
}

/// Numbers that follow from equal counts differ by rounding at most.
bool agree(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return std::abs(*a - *b) <= 1e-9 * std::max(1.0, std::abs(*b));
}

void compare_rates(const Score& said, const ProtocolResult& found, Differences& differences) {
  const std::string& where = said.protocol.name;
  compare_lists(where, "rate", said.rates, found.rates, differences,
                [&](const Rate& theirs, const Rate& ours) {
                  if (agree(theirs.value, ours.value)) return;
                  differences.push_back(fmt::format("{}: {} is {}, the submission says {}", where,
                                                    ours.name, number_or_none(ours.value),
                                                    number_or_none(theirs.value)));
                });
}

/// How intervals were drawn: "level 0.95, 1000 replicates, seed 20260101, blocks of 8 scans".
std::string drawing_of(const Intervals& intervals) {
  const BootstrapOptions& options = intervals.options;
  return fmt::format("level {}, {} replicates, seed {}, blocks of {} scans",
                     number_text(options.level), options.replicates, options.seed,
                     intervals.block_scans);
}

std::string ends_text(const Interval& interval) {
  return number_or_none(interval.low) + " to " + number_or_none(interval.high);
}

void compare_intervals(const Score& said, const ProtocolResult& found, Differences& differences) {
  const std::string& where = said.protocol.name;
  if (!said.intervals || !found.intervals) {
    if (said.intervals.has_value() == found.intervals.has_value()) return;
    differences.push_back(where + ": intervals are there in one of both only");
    return;
  }
  const std::string drawn = drawing_of(*found.intervals), said_drawn = drawing_of(*said.intervals);
  if (drawn != said_drawn) {
    differences.push_back(fmt::format("{}: intervals are drawn with {}, the submission says {}",
                                      where, drawn, said_drawn));
  }
  compare_lists(
      where, "interval of", said.intervals->rates, found.intervals->rates, differences,
      [&](const Interval& theirs, const Interval& ours) {
        if (agree(theirs.low, ours.low) && agree(theirs.high, ours.high)) return;
        differences.push_back(fmt::format("{}: the interval of {} is {}, the submission says {}",
                                          where, ours.name, ends_text(ours), ends_text(theirs)));
      });
}

void compare_columns(const std::vector<ColumnValue>& said, const std::vector<ColumnValue>& found,
                     Differences& differences) {
  compare_lists(
      "points", "column", said, found, differences,
      [&](const ColumnValue& theirs, const ColumnValue& ours) {
        const Share &a = theirs.share, &b = ours.share;
        if (a.part == b.part && a.whole == b.whole) return;
        differences.push_back(fmt::format("points: {} is {} of {}, the submission says {} of {}",
                                          ours.name, b.part, b.whole, a.part, a.whole));
      });
}

CellIdentity identity_of(const Cell& cell) {
  CellIdentity identity{cell.method, *cell.data, {}};
  for (const Score& score : cell.scores) identity.protocols.push_back(score.protocol);
  return identity;
}

/// Why nothing can be verified if this program scores by another version.
std::string other_version(const std::string& what, const std::string& said,
                          const std::string& here) {
  return fmt::format(
      "it was scored by {} version {}, this program has {}; verify it with a version of raymoval "
      "that has this one.",
      what, said, here);
}

/// Why there is nothing to verify, or no way to do it here; else empty.
std::string lack_of(const Cell& cell) {
  if (!cell.ok()) return std::string("the cell has no result: ") + status_name(cell.status);
  if (!cell.data || cell.data->fingerprint.empty()) return "it does not say its data's fingerprint";
  if (!cell.masks) return "it does not say the digest of its masks";
  if (cell.scores.empty()) return "it has no score";
  if (!cell.columns) return "it has no points by class, range and height";
  // The key holds the version, too, so it could not be checked either.
  if (cell.columns->version == kColumnsVersion) return "";
  return other_version("columns", cell.columns->version, kColumnsVersion);
}

/// What of the data is said otherwise, as "frames 0:49:1, the submission has 0:99:1".
std::string other_data(const DataRecord& found, const DataRecord& said) {
  std::vector<std::string> parts;
  const nlohmann::ordered_json ours = to_json(found), theirs = to_json(said);
  for (const auto& [key, value] : theirs.items()) {
    if (key == "name" || key == "source" || key == "layout" || key == "fingerprint") continue;
    const auto our = ours.contains(key) ? ours[key] : nlohmann::ordered_json(nullptr);
    if (our != value)
      parts.push_back(key + " " + our.dump() + ", the submission has " + value.dump());
  }
  return parts.empty() ? "" : " (" + join(parts, "; ") + ")";
}

/// @return whether the data is that of the cell
bool check_data(const Cell& cell, ScoredSequence& scored, Differences& differences) {
  const std::string& found = scored.data_fingerprint();
  if (found == cell.data->fingerprint) return true;
  differences.push_back(fmt::format("data: the fingerprint is {}, the submission says {}{}", found,
                                    cell.data->fingerprint,
                                    other_data(scored.sequence().record(), *cell.data)));
  return false;
}

void check_masks(const Cell& cell, const MaskStore& masks, Differences& differences) {
  const std::string digest = mask_digest(masks);
  if (digest != cell.masks->digest) {
    differences.push_back(
        fmt::format("masks: the hash is {}, the submission says {}", digest, cell.masks->digest));
  }
  const auto removed = static_cast<std::int64_t>(masks.removed_count());
  if (removed != cell.masks->removed) {
    differences.push_back(fmt::format("masks: {} points are removed, the submission says {}",
                                      removed, cell.masks->removed));
  }
}

MaskStore read_masks(const SubmittedCell& submitted, const ScanSource& scans,
                     const std::atomic<bool>* cancel) {
  if (!has_folder(submitted.masks)) {
    throw DataError(submitted.masks.string() +
                    ": the masks are not there. Say where they are with --masks, a folder with a "
                    "label file for each scan.");
  }
  return read_removals(submitted.masks, scans, [&] {
    if (cancel != nullptr && cancel->load()) throw Cancelled();
  });
}

void check_scores(const Cell& cell, const SequenceScores& scores, Differences& differences) {
  for (std::size_t i = 0; i < cell.scores.size(); ++i) {
    compare_counts(cell.scores[i], scores.protocols[i], differences);
    compare_rates(cell.scores[i], scores.protocols[i], differences);
    compare_intervals(cell.scores[i], scores.protocols[i], differences);
    if (cell.scores[i].by_scan != scores.protocols[i].by_scan) {
      differences.push_back(cell.scores[i].protocol.name + ": the counts of scans are others");
    }
  }
  compare_columns(cell.columns->values, scores.columns, differences);
}

}  // namespace

SubmissionVerdict Verification::verdict() const {
  if (!differences.empty()) return SubmissionVerdict::kDiffers;
  return problem.empty() ? SubmissionVerdict::kHolds : SubmissionVerdict::kUnchecked;
}

std::vector<ProtocolRequest> requested_protocols_of(const Cell& cell) {
  std::vector<ProtocolRequest> requests;
  for (const Score& score : cell.scores) {
    const ProtocolRecord& said = score.protocol;
    const ProtocolEntry* entry = find_protocol(said.protocol);
    const std::string here = entry == nullptr ? "none" : entry->version;
    if (here != said.version) {
      throw DataError(other_version("protocol " + said.protocol, said.version, here));
    }
    requests.push_back({said.name, said.protocol, said.options});
  }
  return requests;
}

SequenceOptions reading_of(const Cell& cell, SequenceOptions given) {
  if (!cell.data) return given;
  const DataRecord& data = *cell.data;
  if (!given.frames && !data.frames.empty()) given.frames = parse_frame_range(data.frames);
  if (!given.range_m) given.range_m = data.range_m;
  if (!given.drop_ego && data.drop_ego) given.drop_ego = parse_ego_region(data.drop_ego->asked);
  if (!given.name) given.name = cell.sequence;
  return given;
}

bool same_data(const Cell& a, const Cell& b) {
  return a.data && b.data && a.data->fingerprint == b.data->fingerprint;
}

bool same_scoring(const ProtocolRecord& a, const ProtocolRecord& b) {
  return a.protocol == b.protocol && a.version == b.version && a.options == b.options;
}

bool same_sequence(const Cell& a, const Cell& b) {
  return same_data(a, b) && std::equal(a.scores.begin(), a.scores.end(), b.scores.begin(),
                                       b.scores.end(), [](const Score& one, const Score& other) {
                                         return one.protocol.name == other.protocol.name &&
                                                same_scoring(one.protocol, other.protocol);
                                       });
}

Verification verify_cell(const SubmittedCell& submitted, ScoredSequence& scored,
                         const std::atomic<bool>* cancel) {
  Verification result{submitted, {}};
  const Cell& cell = submitted.cell;
  result.problem = lack_of(cell);
  if (!result.problem.empty()) return result;
  try {
    if (cell_key(identity_of(cell)) != cell.key) {
      result.differences.emplace_back(
          "key: it does not follow from method, version, parameters, data and protocols; one of "
          "them was changed after the run");
    }
    if (!check_data(cell, scored, result.differences)) return result;
    const MaskStore masks = read_masks(submitted, *scored.sequence().scans, cancel);
    check_masks(cell, masks, result.differences);
    result.scores = scored.score(masks, cancel);
    check_scores(cell, result.scores, result.differences);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    if (error.exit_code() == ExitCode::kInternal) throw;
    result.problem = error.what();
  }
  return result;
}

std::string verification_text(const Verification& verification) {
  const SubmittedCell& submitted = verification.submitted;
  const char* const verdicts[] = {"holds", "does not hold", "cannot be checked"};
  std::string text = fmt::format("{} ({}): {}\n", submitted.cell.title(), submitted.from,
                                 verdicts[static_cast<int>(verification.verdict())]);
  constexpr std::size_t kShown = 12;
  for (std::size_t i = 0; i < verification.differences.size() && i < kShown; ++i) {
    text += "  " + verification.differences[i] + "\n";
  }
  if (verification.differences.size() > kShown) {
    text += fmt::format("  and {} more\n", verification.differences.size() - kShown);
  }
  if (!verification.problem.empty()) text += "  " + verification.problem + "\n";
  return text;
}

}  // namespace raymoval
