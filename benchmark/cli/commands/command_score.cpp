// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "benchmark/clean/cleaned_cloud.h"
#include "benchmark/cli/commands.h"
#include "benchmark/result/cell.h"
#include "benchmark/result/removal_files.h"
#include "benchmark/result/results.h"
#include "benchmark/result/score_json.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/run/sequence_bench.h"
#include "core/files/files.h"
#include "core/parallel.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "eval/rate.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

struct ScoreFlags {
  std::string sequence, predictions, cloud, voxel, json, threads;
  std::vector<std::string> protocols, settings;
  SequenceFlags reading;
  bool quiet = false;
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
    if (column.name.find("range ") != std::string::npos ||
        column.name.find("height ") != std::string::npos) {
      continue;
    }
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
    record_["data"] = bench.sequence().record();
    record_["data"]["scans"] = bench.sequence().scans->size();
  }

  ordered_json run() {
    record_["labels"] = flags_.cloud.empty() ? "index" : "nearest";
    record_["protocols"] = ordered_json::array();
    const MaskStore masks = flags_.cloud.empty() ? score_predictions() : score_cloud();
    const std::vector<ColumnValue> columns = bench_.columns(masks);
    record_["columns"] = columns_record(columns);
    text_ += columns_text(columns);
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
    ordered_json scored;
    scored["name"] = bench_.protocol_name(i);
    scored["protocol"] = bench_.protocol(i).name();
    scored["version"] = bench_.protocol(i).version();
    scored["options"] = to_json(bench_.protocol(i).options());
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
  if (suite.protocols.empty()) add_protocol(suite, "erasor", "");
  for (ProtocolRequest& request : suite.protocols) {
    if (flags.cloud.empty() || request.protocol != "erasor") continue;
    set_parameter(request.options, "label_mode", std::string("nearest"));
    set_parameter(request.options, "lift", 0.0);
  }
  for (const std::string& text : flags.settings) {
    set_protocol_option(suite.protocols, parse_setting(text));
  }
  return suite.protocols;
}

ExitCode score(const ScoreFlags& flags) {
  check_flags(flags);
  const std::vector<ProtocolRequest> protocols = requested_protocols(flags);
  const int given = parse_threads(flags.threads);
  const int threads = given > 0 ? given : hardware_threads();
  Progress progress(flags.quiet ? ProgressStyle::kQuiet : progress_style_of_stderr());
  SequenceBench bench(open_sequence(flags.sequence, flags.reading.options(),
                                    {threads, &progress, &interrupt_flag()}),
                      protocols, threads, &progress);
  const ordered_json record = Scoring(bench, flags, progress).run();
  if (!flags.json.empty()) write_atomically(flags.json, json_text(record));
  return ExitCode::kDone;
}

}  // namespace

Command add_score_command(CLI::App& program) {
  auto flags = std::make_shared<ScoreFlags>();
  CLI::App* app =
      program.add_subcommand("score", "Scores label files or a cleaned map made by any program");
  app->allow_extras();
  SequenceFlags::add_place_to(*app, flags->sequence);
  app->add_option("--predictions", flags->predictions,
                  "Folder of NNNNNN.label files: 251 to 259 = removed, others kept")
      ->type_name("DIR");
  app->add_option("--cloud", flags->cloud,
                  "Cleaned map (.pcd, .ply, .bin) in the world frame of the poses")
      ->type_name("FILE");
  app->add_option("--voxel", flags->voxel,
                  "Voxel to which the cloud was thinned; thins the oracle's likewise")
      ->type_name("METRES");
  app->add_option("--protocol", flags->protocols, "Protocol to score by (default: erasor)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  app->add_option("--set", flags->settings, "Option of a protocol: protocol:NAME.key=value")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  flags->reading.add_to(*app);
  app->add_option("--json", flags->json, "Write counts and rates to this file")->type_name("FILE");
  app->add_option("--threads", flags->threads, "At most so many threads (default: all cores)")
      ->type_name("N");
  app->add_flag("--quiet", flags->quiet, "No progress");
  app->footer(
      "A cloud has no labels: they are found again by nearest neighbour, which keeps even a "
      "perfect\ncleaner below 100. What the oracle's cloud scores in the same way is shown beside "
      "it. That is a\nyardstick and no upper limit: whoever also removes static points beside "
      "moving "
      "ones can have a\nhigher RR or DA.\nExamples:\n"
      "  raymoval score --sequence data/05 --predictions out/labels\n"
      "  raymoval score --sequence data/05 --cloud static.pcd --voxel 0.1 --protocol erasor "
      "--protocol dynamicmap\n"
      "  raymoval score data/05 --predictions out/labels --protocol dynamicmap "
      "--set protocol:dynamicmap.distance=0.1\n"
      "  raymoval score --sequence street --predictions "
      "out/street/cells/street/raymoval-online/removals --json score.json");
  return {app, [flags] { return score(*flags); }};
}

}  // namespace raymoval
