// SPDX-License-Identifier: MIT
#include "benchmark/submission/verification.h"

#include <fmt/format.h>

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

void compare_counts(const Score& said, const ProtocolResult& found, Differences& differences) {
  const std::string& name = said.protocol.name;
  for (const auto& [count, value] : said.counts) {
    bool known = false;
    for (const auto& [other, counted] : found.counts) {
      if (other != count) continue;
      known = true;
      if (counted == value) continue;
      differences.push_back(
          fmt::format("{}: {} is {}, the submission says {}", name, count, counted, value));
    }
    if (!known) differences.push_back(fmt::format("{}: there is no count {}", name, count));
  }
  if (said.counts.size() < found.counts.size()) {
    differences.push_back(fmt::format("{}: the submission lacks counts ({} of {})", name,
                                      said.counts.size(), found.counts.size()));
  }
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
  const std::string& name = said.protocol.name;
  for (const Rate& rate : found.rates) {
    const auto other = said.rate(rate.name);
    if (agree(other, rate.value)) continue;
    differences.push_back(fmt::format("{}: {} is {}, the submission says {}", name, rate.name,
                                      number_or_none(rate.value), number_or_none(other)));
  }
}

void compare_intervals(const Score& said, const ProtocolResult& found, Differences& differences) {
  const std::string& name = said.protocol.name;
  if (!said.intervals || !found.intervals) {
    if (said.intervals.has_value() == found.intervals.has_value()) return;
    differences.push_back(name + ": intervals are there in one of both only");
    return;
  }
  const auto& theirs = said.intervals->rates;
  const auto& ours = found.intervals->rates;
  bool same = theirs.size() == ours.size();
  for (std::size_t i = 0; same && i < ours.size(); ++i) {
    same = theirs[i].name == ours[i].name && agree(theirs[i].low, ours[i].low) &&
           agree(theirs[i].high, ours[i].high);
  }
  if (!same) differences.push_back(name + ": the intervals are others");
}

void compare_columns(const Cell& cell, const std::vector<ColumnValue>& found,
                     Differences& differences) {
  if (!cell.columns || cell.columns->version != kColumnsVersion) return;
  for (const ColumnValue& said : cell.columns->values) {
    for (const ColumnValue& column : found) {
      if (column.name != said.name) continue;
      if (column.share.part == said.share.part && column.share.whole == said.share.whole) continue;
      differences.push_back(fmt::format("points: {} is {} of {}, the submission says {} of {}",
                                        column.name, column.share.part, column.share.whole,
                                        said.share.part, said.share.whole));
    }
  }
}

CellIdentity identity_of(const Cell& cell) {
  CellIdentity identity{cell.method, *cell.data, {}};
  for (const Score& score : cell.scores) identity.protocols.push_back(score.protocol);
  return identity;
}

/// Why there is nothing to verify; else empty.
std::string lack_of(const Cell& cell) {
  if (!cell.ok()) return std::string("the cell has no result: ") + status_name(cell.status);
  if (!cell.data || cell.data->fingerprint.empty()) return "it does not say its data's fingerprint";
  if (!cell.masks) return "it does not say the digest of its masks";
  if (cell.scores.empty()) return "it has no score";
  return "";
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
  compare_columns(cell, scores.columns, differences);
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
      throw DataError(fmt::format(
          "it was scored by protocol {} version {}, this program has {}; verify it with a version "
          "of raymoval that has this one.",
          said.protocol, said.version, here));
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

bool comparable(const Cell& a, const Cell& b) {
  if (!a.data || !b.data || a.data->fingerprint != b.data->fingerprint) return false;
  if (a.scores.size() != b.scores.size()) return false;
  for (std::size_t i = 0; i < a.scores.size(); ++i) {
    if (to_json(a.scores[i].protocol) != to_json(b.scores[i].protocol)) return false;
  }
  return true;
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
