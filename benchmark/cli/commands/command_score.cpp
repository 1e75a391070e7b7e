// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/clean/cleaned_cloud.h"
#include "benchmark/cli/commands.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/result/removal_files.h"
#include "benchmark/result/results.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/sequence_bench.h"
#include "core/files/files.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

struct ScoreFlags {
  std::string sequence, predictions, cloud, voxel, json;
  std::vector<std::string> protocols, settings;
  SequenceFlags reading;
  WorkFlags work;
};

/// "PR 99.422 (99.131 to 99.689)".
std::string rate_line(const Rate& rate, const ProtocolResult& result) {
  std::string text = "  " + rate.name + " ";
  if (!rate.value) return text + "n/a (" + rate.undefined_reason + ")\n";
  text += rate_text(rate.name, *rate.value);
  if (!result.intervals) return text + "\n";
  for (const Interval& interval : result.intervals->rates) {
    if (interval.name != rate.name || !interval.low || !interval.high) continue;
    text += " (" + rate_text(rate.name, *interval.low) + " to " +
            rate_text(rate.name, *interval.high) + ")";
  }
  return text + "\n";
}

std::string result_text(const std::string& name, const ProtocolResult& result) {
  std::string text = "protocol " + name + "\n";
  for (const auto& [count, value] : result.counts) {
    text += "  " + count + " " + std::to_string(value) + "\n";
  }
  for (const Rate& rate : result.rates) text += rate_line(rate, result);
  for (const std::string& warning : result.warnings) text += "  warning: " + warning + "\n";
  return text;
}

/// Columns without a band, as "precision 61.662 (25796 of 41835)".
std::string columns_text(const std::vector<ColumnValue>& columns) {
  std::string text = "points\n";
  for (const ColumnValue& column : columns) {
    if (!parse_column_name(column.name).axis.empty()) continue;
    const auto percent = column.share.percent();
    text += "  " + column.name + " " +
            (percent ? fixed_text(*percent, 3) + " (" + std::to_string(column.share.part) + " of " +
                           std::to_string(column.share.whole) + ")"
                     : "n/a (" + column.undefined_reason + ")") +
            "\n";
  }
  return text;
}

std::string oracle_text(const ProtocolResult& result) {
  std::string text = "  the oracle\'s cloud, scored in the same way:";
  for (const Rate& rate : result.rates) {
    text += " " + rate.name + " " + (rate.value ? rate_text(rate.name, *rate.value) : "n/a");
  }
  return text + "\n";
}

/// Why a cloud may be better by some rates than one without a single mistake; empty if it is not.
std::string above_oracle_text(const ProtocolResult& result, const ProtocolResult& oracle) {
  std::vector<std::string> above;
  for (const Rate& rate : result.rates) {
    const auto perfect = oracle.rate(rate.name);
    if (!rate.value || !perfect) continue;
    const double gain = *rate.value - *perfect;
    if (rate_spec(rate.name).higher_is_better ? gain > 0.0 : gain < 0.0) above.push_back(rate.name);
  }
  if (above.empty()) return "";
  return "  " + join(above) +
         " above the oracle\'s: that is no upper limit. The oracle keeps every static point; where "
         "one stands\n  beside a moving one, that one counts as kept, and thinning puts means "
         "where "
         "no point was.\n";
}

/// What is scored, and what it is scored by.
class Scoring {
 public:
  Scoring(SequenceBench& bench, const ScoreFlags& flags, Progress& progress)
      : bench_(bench), flags_(flags), progress_(progress) {
    record_["schema_version"] = kSchemaVersion;
    record_["data"] = to_json(bench.sequence().record());
  }

  ordered_json run() {
    record_["labels"] = flags_.cloud.empty() ? "index" : "nearest";
    record_["protocols"] = ordered_json::array();
    const MaskStore masks = flags_.cloud.empty() ? score_predictions() : score_cloud();
    const ColumnRecord columns{kColumnsVersion, bench_.columns(masks)};
    record_["columns"] = to_json(columns);
    text_ += columns_text(columns.values);
    progress_.end();
    print(text_);
    return std::move(record_);
  }

 private:
  MaskStore score_predictions() {
    const ScanSource& scans = *bench_.sequence().scans;
    progress_.begin("reading predictions", scans.size());
    const std::atomic<bool>& cancelled = interrupt_flag();
    MaskStore masks = read_removals(flags_.predictions, scans, [&] {
      progress_.advance();
      if (cancelled) throw Cancelled();
    });
    for (std::size_t i = 0; i < bench_.protocol_count(); ++i) {
      add_result(i, bench_.score(i, masks), nullptr);
    }
    return masks;
  }

  MaskStore score_cloud() {
    const double voxel = flags_.voxel.empty() ? 0.0 : parse_positive("--voxel", flags_.voxel);
    const CleanedCloud cloud =
        read_cleaned_cloud(flags_.cloud, lattice_origin(*bench_.sequence().scans));
    record_["cloud"]["points"] = cloud.stored;
    record_["cloud"]["non_finite"] = cloud.non_finite;
    record_["cloud"]["oracle_voxel_m"] = voxel;
    record_["cloud"]["warnings"] = cloud.warnings();
    text_ += "cloud of " + grouped_text(cloud.stored) +
             " points: labels by nearest neighbour, points present within 0.05 m; not to be "
             "compared with scores by index\n";
    for (const std::string& warning : cloud.warnings()) text_ += "  warning: " + warning + "\n";
    const std::vector<ProtocolResult> oracles = oracle_results(voxel);
    const CloudEstimate estimate(cloud.points);
    for (std::size_t i = 0; i < bench_.protocol_count(); ++i) {
      if (interrupt_flag()) throw Cancelled();
      add_result(i, bench_.score_cloud(i, estimate), &oracles[i]);
    }
    return bench_.cloud_masks(estimate);
  }

  /// What the oracle's cloud scores by each protocol.
  std::vector<ProtocolResult> oracle_results(double voxel) {
    const CleanedCloud oracle = oracle_cloud(bench_.sequence(), voxel, &progress_);
    const CloudEstimate estimate(oracle.points);
    std::vector<ProtocolResult> results;
    for (std::size_t i = 0; i < bench_.protocol_count(); ++i) {
      if (interrupt_flag()) throw Cancelled();
      results.push_back(bench_.score_cloud(i, estimate));
    }
    return results;
  }

  /// @param oracle what the oracle's cloud scored; null where labels go by index
  void add_result(std::size_t i, const ProtocolResult& result, const ProtocolResult* oracle) {
    ordered_json scored =
        to_json(ProtocolRecord{bench_.protocol_name(i), bench_.protocol(i).name(),
                               bench_.protocol(i).version(), bench_.protocol(i).options()});
    scored.update(to_json(result));
    text_ += result_text(bench_.protocol_name(i), result);
    if (oracle != nullptr) {
      scored["oracle"] = to_json(*oracle)["rates"];
      text_ += oracle_text(*oracle) + above_oracle_text(result, *oracle);
    }
    record_["protocols"].push_back(std::move(scored));
  }

  SequenceBench& bench_;
  const ScoreFlags& flags_;
  Progress& progress_;
  ordered_json record_;
  std::string text_;
};

void check_flags(const ScoreFlags& flags) {
  if (flags.sequence.empty())
    throw UsageError("score what? Expected `raymoval score PATH --predictions DIR`.");
  check_not_both(flags.sequence);
  if (flags.predictions.empty() && flags.cloud.empty()) {
    throw UsageError(
        "--predictions DIR is missing: the folder with a label file for each scan (or a map with "
        "--cloud FILE).");
  }
  if (!flags.predictions.empty() && !flags.cloud.empty()) {
    throw UsageError("--predictions and --cloud exclude each other; score them one by one.");
  }
  if (!flags.json.empty()) check_folder_of(flags.json);
  if (flags.cloud.empty() && !flags.voxel.empty()) {
    throw UsageError("--voxel goes with --cloud: it says how the cloud was thinned.");
  }
}

/// The protocols asked for. A cloud stands where the poses put it and has no labels.
std::vector<ProtocolRequest> requested_protocols(const ScoreFlags& flags) {
  Suite suite;
  for (const std::string& protocol : flags.protocols) add_protocol(suite, protocol, "");
  if (suite.protocols.empty()) add_protocol(suite, default_protocol(), "");
  for (ProtocolRequest& request : suite.protocols) {
    if (flags.cloud.empty()) continue;
    for (const auto& [key, value] : protocol_entry(request.protocol).cloud_options) {
      set_parameter(request.options, key, value);
    }
  }
  for (const std::string& text : flags.settings) {
    set_protocol_option(suite.protocols, parse_setting(text));
  }
  return suite.protocols;
}

ExitCode score(const ScoreFlags& flags) {
  check_flags(flags);
  const std::vector<ProtocolRequest> protocols = requested_protocols(flags);
  const int threads = flags.work.thread_count();
  Progress progress(flags.work.style());
  SequenceBench bench(open_sequence(flags.sequence, flags.reading.options(),
                                    {threads, &progress, &interrupt_flag()}),
                      protocols, &progress);
  const ordered_json record = Scoring(bench, flags, progress).run();
  if (!flags.json.empty()) write_atomically(flags.json, json_text(record));
  return ExitCode::kDone;
}

}  // namespace

Command add_score_command(CommandParser& program) {
  auto flags = std::make_shared<ScoreFlags>();
  CommandOptions options =
      program.add_command("score", "Scores label files or a cleaned map made by any program");
  SequenceFlags::add_place_to(options, flags->sequence);
  options.add(
      "--predictions", "DIR", flags->predictions,
      "A folder of NNNNNN.label files, in which 251 to 259 mean removed and other labels kept");
  options.add("--cloud", "FILE", flags->cloud,
              "A cleaned map (.pcd, .ply, .bin) in the world frame of the poses");
  options.add("--voxel", "METRES", flags->voxel,
              "The voxel size to which the cloud was thinned; the oracle's cloud is thinned in the "
              "same way");
  options.add("--protocol", "NAME", flags->protocols, "The protocol to score by (default: erasor)");
  options.add("--set", "SETTING", flags->settings,
              "An option of a protocol: protocol:NAME.key=value");
  flags->reading.add_to(options);
  options.add("--json", "FILE", flags->json, "Write counts and rates to this file");
  flags->work.add_to(options);
  options.set_footer(
      "A cloud has no labels: they are found again by nearest neighbour, which keeps even a "
      "perfect\ncleaner below 100. What the oracle's cloud scores in the same way is shown beside "
      "it. That is a\nyardstick and no upper limit: a method that also removes static points "
      "beside moving ones\ncan have a higher RR or DA.\nExamples:\n"
      "  raymoval score --sequence data/05 --predictions out/labels\n"
      "  raymoval score --sequence data/05 --cloud static.pcd --voxel 0.1 --protocol erasor "
      "--protocol dynamicmap\n"
      "  raymoval score data/05 --predictions out/labels --protocol dynamicmap "
      "--set protocol:dynamicmap.distance=0.1\n"
      "  raymoval score --sequence street --predictions "
      "out/street/cells/street/raymoval-online/removals --json score.json");
  return {options.name(), [flags] { return score(*flags); }};
}

}  // namespace raymoval
