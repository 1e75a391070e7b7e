// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/clean/clean_paths.h"
#include "benchmark/clean/cleaned_cloud.h"
#include "benchmark/cli/command.h"
#include "benchmark/result/cell.h"
#include "benchmark/result/removals/edits.h"
#include "benchmark/result/removals/removal_files.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/run/scored_sequence.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/scan/local_frame.h"
#include "core/terminal_colour.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/truth_map.h"
#include "eval/protocol_registry.h"

namespace raymoval {

/// A cleaned map that was scored.
struct CloudRecord {
  std::size_t points = 0;       ///< Number of points in the file.
  std::size_t non_finite = 0;   ///< Points that were left out, see `CleanedCloud`.
  double oracle_voxel_m = 0.0;  ///< Voxels that thin the oracle's cloud; 0: not thinned.
  std::vector<std::string> warnings;
};

/// The result of one protocol.
struct ScoredProtocol {
  ProtocolRecord protocol;
  ProtocolResult result;
  /// The result of the oracle's cloud. No value if label files were scored.
  std::optional<ProtocolResult> oracle = std::nullopt;
  /// The result of all points, thinned as the cloud. No value if the cloud was not thinned.
  std::optional<ProtocolResult> thinned = std::nullopt;
};

/// The content of `raymoval score`.
struct ScoreRecord {
  DataRecord data;
  std::optional<PoseFitRecord> pose_fit;
  std::optional<CloudRecord> cloud;  ///< No value if label files were scored.
  std::vector<ScoredProtocol> protocols;
  ColumnRecord columns;
};

static void describe(RecordWriter& writer, const ScoredProtocol& scored) {
  describe(writer, scored.protocol);
  describe(writer, scored.result);
  if (scored.oracle) writer.json["oracle"] = to_json(*scored.oracle)["rates"];
  if (scored.thinned) writer.json["thinned"] = to_json(*scored.thinned)["rates"];
}

static void describe(RecordWriter& writer, const CloudRecord& cloud) {
  writer.field("points", cloud.points);
  writer.field("non_finite", cloud.non_finite);
  writer.field("oracle_voxel_m", cloud.oracle_voxel_m);
  writer.field("warnings", cloud.warnings);
}

namespace {

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

std::string cloud_text(const CloudRecord& cloud) {
  std::string text = fmt::format(
      "cloud of {} points: labels by nearest neighbour, points present within 0.05 m; "
      "not to be compared with scores by index\n",
      grouped_text(cloud.points));
  for (const std::string& warning : cloud.warnings) text += "  warning: " + warning + "\n";
  return text;
}

/// "  the oracle's cloud, scored in the same way: PR 99.422 RR 99.131".
std::string rates_line(const std::string& cloud, const ProtocolResult& result) {
  std::string text = "  " + cloud + ", scored in the same way:";
  for (const Rate& rate : result.rates) {
    text += " " + rate.name + " " + (rate.value ? rate_text(rate.name, *rate.value) : "n/a");
  }
  return text + "\n";
}

/// Why a cloud has better rates than a perfect one; empty if it has not.
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
         " above the oracle's, which is not an upper limit. The oracle keeps every static point: a "
         "moving\n"
         "  point beside a static one counts as kept, and thinning puts means where no point "
         "was.\n";
}

std::string score_text(const ScoreRecord& record) {
  std::string text = record.cloud ? cloud_text(*record.cloud) : "";
  for (const ScoredProtocol& scored : record.protocols) {
    text += result_text(scored.protocol.name, scored.result);
    if (!scored.oracle) continue;
    text += rates_line("the oracle's cloud", *scored.oracle);
    if (scored.thinned) text += rates_line("all points, only thinned", *scored.thinned);
    text += above_oracle_text(scored.result, *scored.oracle);
  }
  if (record.columns.values.empty()) return text;
  return text + columns_text(record.columns.values);
}

std::string score_json(const ScoreRecord& record) {
  RecordWriter writer;
  writer.schema_version();
  writer.field("data", record.data);
  writer.optional("pose_fit", record.pose_fit);
  writer.field("labels", record.cloud ? "nearest" : "index");
  writer.field("protocols", record.protocols);
  writer.optional("cloud", record.cloud);
  writer.field("columns", record.columns);
  return json_text(writer.json);
}

struct ScoreFlags {
  std::string sequence, truth_map, truth, predictions, cloud, voxel;
  OutputFlag json;
  std::vector<std::string> protocols, settings;
  SequenceFlags reading;
  WorkFlags work;
};

std::vector<ProtocolRecord> protocol_records(const ScoredSequence& scored) {
  std::vector<ProtocolRecord> records;
  for (std::size_t i = 0; i < scored.protocol_count(); ++i) {
    const Protocol& protocol = scored.protocol(i);
    records.push_back(
        {scored.protocol_name(i), protocol.name(), protocol.version(), protocol.options()});
  }
  return records;
}

/// Warns of other labels: masks of 0 and 1, for example, would be read as a result that removes
/// nothing.
void warn_of_labels(const LabelIds& found, const std::string& folder) {
  print_warning(folder +
                ": no point has a label from 251 to 259, so none counts as removed; found " +
                label_ids_text(found) +
                ". If some are to be removed, write 251 for those and 9 for the others.");
}

/// Whether `--predictions` names a file of edits.
bool is_edits(const std::string& path) {
  return std::filesystem::path(path).extension() == ".json" && is_file(path);
}

/// The corrected masks of a file of edits.
MaskStore edited_masks(const std::string& file, const ScanSource& scans, Progress& progress) {
  const Edits edits = read_edits(file);
  progress.begin("applying " + file, scans.size());
  EditedMasks edited = apply_edits(edits, scans, file, false, [&progress] {
    progress.advance();
    if (interrupt_flag()) throw Cancelled();
  });
  progress.end();
  return std::move(edited.masks);
}

/// Makes a reviewed answer the labels of `sequence`: removed points move.
void set_truth(Sequence& sequence, const std::string& file, Progress& progress) {
  sequence.labels = labels_of_masks(edited_masks(file, *sequence.scans, progress));
  sequence.label_rule = {
      "reviewed", {kRemovedLabel}, {}, {{kKeptLabel, "kept"}, {kRemovedLabel, "removed"}}};
}

void score_predictions(ScoredSequence& scored, const std::string& folder, Progress& progress,
                       ScoreRecord& record) {
  const ScanSource& scans = *scored.sequence().scans;
  const std::atomic<bool>& cancelled = interrupt_flag();
  Predictions read;
  if (is_edits(folder)) {
    read.masks = edited_masks(folder, scans, progress);
  } else {
    progress.begin("reading predictions", scans.size());
    read = read_predictions(folder, scans, scored.sequence().label_rule, [&] {
      progress.advance();
      if (cancelled) throw Cancelled();
    });
    progress.end();
  }
  if (!read.note.empty()) progress.say(folder + ": " + read.note);
  if (read.masks.removed_count() == 0 && !is_edits(folder)) warn_of_labels(read.found.ids, folder);
  SequenceScores scores = scored.score(read.masks, &cancelled);
  const std::vector<ProtocolRecord> protocols = protocol_records(scored);
  for (std::size_t i = 0; i < protocols.size(); ++i) {
    record.protocols.push_back({protocols[i], std::move(scores.protocols[i])});
  }
  record.columns = {kColumnsVersion, std::move(scores.columns)};
}

std::vector<ProtocolResult> score_cloud(ScoredSequence& scored, const CloudEstimate& cloud) {
  std::vector<ProtocolResult> results;
  for (std::size_t i = 0; i < scored.protocol_count(); ++i) {
    if (interrupt_flag()) throw Cancelled();
    results.push_back(scored.score_cloud(i, cloud));
  }
  return results;
}

/// @param voxel_m by which the cloud was thinned; 0: not thinned
void score_cloud(ScoredSequence& scored, const std::string& file, double voxel_m,
                 Progress& progress, ScoreRecord& record) {
  const CleanedCloud cloud = read_cleaned_cloud(file, lattice_origin(*scored.sequence().scans));
  record.cloud = {cloud.stored, cloud.non_finite, voxel_m, cloud.warnings()};
  std::vector<ProtocolResult> oracle, thinned;
  {
    const CleanedCloud best = oracle_cloud(scored.sequence(), voxel_m, &progress);
    if (voxel_m == 0.0 && 2 * cloud.points.size() < best.points.size()) {
      record.cloud->warnings.push_back("the cloud has less than half of the " +
                                       grouped_text(best.points.size()) +
                                       " static points. If it was thinned, give the voxel size "
                                       "(--voxel), and the score says what that costs");
    }
    oracle = score_cloud(scored, CloudEstimate(best.points));
  }
  if (voxel_m > 0.0) {
    const CleanedCloud whole = whole_cloud(scored.sequence(), voxel_m, &progress);
    thinned = score_cloud(scored, CloudEstimate(whole.points));
  }
  const CloudEstimate estimate(cloud.points);
  const std::vector<ProtocolResult> results = score_cloud(scored, estimate);
  for (const ProtocolRecord& protocol : protocol_records(scored)) {
    const std::size_t i = record.protocols.size();
    record.protocols.push_back({protocol, results[i], oracle[i]});
    if (voxel_m > 0.0) record.protocols.back().thinned = thinned[i];
  }
  // A map does not record the sensor position of its points.
  const bool is_map = scored.sequence().layout == kMapLayout;
  record.columns = {kColumnsVersion, {}};
  if (!is_map) record.columns.values = scored.columns(scored.cloud_masks(estimate));
}

/// A map has labels and a name, but no scans.
void check_is_of_maps(SequenceFlags reading) {
  for (const char* option : {"label-rule", "name"}) reading.texts[option].clear();
  const std::string given = reading.first_given();
  if (given.empty()) return;
  throw UsageError(given + " needs scans, and --truth-map has none. Leave it out.");
}

void check_flags(const ScoreFlags& flags) {
  if (flags.sequence.empty() && flags.truth_map.empty())
    throw UsageError("PATH is missing: expected `raymoval score PATH --predictions DIR`.");
  if (!flags.truth_map.empty() && (!flags.sequence.empty() || flags.cloud.empty())) {
    throw UsageError(
        "--truth-map FILE replaces the sequence and needs --cloud FILE: `raymoval score "
        "--truth-map FILE --cloud FILE`.");
  }
  if (!flags.sequence.empty()) check_not_both(flags.sequence);
  if (!flags.truth_map.empty()) check_is_of_maps(flags.reading);
  if (flags.predictions.empty() && flags.cloud.empty()) {
    throw UsageError(
        "--predictions DIR is missing: the folder with a label file for each scan (or a map with "
        "--cloud FILE).");
  }
  if (!flags.truth.empty() && flags.sequence.empty()) {
    throw UsageError(
        "--truth FILE needs the sequence that was reviewed: `raymoval score PATH --truth "
        "FILE`.");
  }
  if (!flags.predictions.empty() && !flags.cloud.empty()) {
    throw UsageError("--predictions and --cloud exclude each other; score them one by one.");
  }
  flags.json.check();
  if (flags.cloud.empty() && !flags.voxel.empty()) {
    throw UsageError("--voxel needs --cloud: it is the voxel size to which the cloud was thinned.");
  }
}

/// The requested protocols. A cloud is in the frame of the poses and has no labels.
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

void check_json_is_no_input(const ScoreFlags& flags, const std::string& predictions,
                            const Sequence& sequence) {
  std::vector<std::filesystem::path> inputs = files_of(sequence);
  for (const std::filesystem::path& file : flags.reading.files()) inputs.push_back(file);
  if (!flags.cloud.empty()) inputs.emplace_back(flags.cloud);
  for (const std::string& file : {flags.truth_map, flags.truth, flags.predictions}) {
    if (is_file(file)) inputs.emplace_back(file);
  }
  if (is_folder(predictions)) {
    for (const std::filesystem::path& file : entries_of(predictions)) inputs.push_back(file);
  }
  flags.json.check_is_none_of(inputs);
}

ExitCode score(const ScoreFlags& flags) {
  check_flags(flags);
  const std::vector<ProtocolRequest> protocols = requested_protocols(flags);
  const int threads = flags.work.thread_count();
  Progress progress(flags.work.style());
  const SequenceOptions options = flags.reading.options();
  Sequence sequence =
      flags.truth_map.empty()
          ? open_sequence(flags.sequence, options, {threads, &progress, &interrupt_flag()})
          : open_truth_map(flags.truth_map, options);
  report_opening(sequence, progress);
  const std::string predictions =
      flags.predictions.empty() || is_edits(flags.predictions)
          ? flags.predictions
          : prediction_folder(flags.predictions, sequence.name).string();
  check_json_is_no_input(flags, predictions, sequence);
  if (!flags.truth.empty()) set_truth(sequence, flags.truth, progress);
  ScoredSequence scored(std::move(sequence), protocols, threads, &progress);
  ScoreRecord record;
  record.data = scored.sequence().record();
  record.pose_fit = scored.measure_pose_fit(&interrupt_flag());
  const std::string fit_line = pose_fit_line(record.pose_fit);
  if (!fit_line.empty()) print_warning(fit_line);
  if (flags.cloud.empty()) {
    score_predictions(scored, predictions, progress, record);
  } else {
    const double voxel = flags.voxel.empty() ? 0.0 : parse_positive("--voxel", flags.voxel);
    score_cloud(scored, flags.cloud, voxel, progress, record);
  }
  progress.end();
  print(score_text(record));
  flags.json.write(score_json(record));
  return ExitCode::kDone;
}

}  // namespace

Command add_score_command(CommandParser& program) {
  auto flags = std::make_shared<ScoreFlags>();
  CommandOptions options =
      program.add_command("score", "Scores label files or a cleaned map made by any program");
  SequenceFlags::add_place_to(options, flags->sequence);
  options.add("--truth-map", "FILE", flags->truth_map,
              "A labelled map in place of a sequence, for --cloud: the intensity of a point is its "
              "label, 0 or 1 (1 moves), or SemanticKITTI's");
  options.add(
      "--truth", "FILE", flags->truth,
      "The edits.json of a reviewed map (`raymoval clean --html`) in place of labels: removed "
      "points move, others are static");
  options.add(
      "--predictions", "DIR", flags->predictions,
      "A folder of NNNNNN.label files, in which 251 to 259 mean removed and other labels kept, or "
      "of "
      ".npy masks (see the docs for learning ids); or the folder above sequences/NN/predictions; "
      "or "
      "the edits.json of a reviewed map");
  options.add("--cloud", "FILE", flags->cloud,
              "A cleaned map (.pcd, .ply, .bin) in the world frame of the poses");
  options.add(
      "--voxel", "METRES", flags->voxel,
      "The voxel size to which the cloud was thinned; the oracle's cloud is thinned in the "
      "same way, and so is a cloud of all points, whose score is what thinning alone costs");
  options.add("--protocol", "NAME", flags->protocols, "The protocol to score by (default: erasor)");
  options.add("--set", "SETTING", flags->settings,
              "An option of a protocol: protocol:NAME.key=value");
  flags->reading.add_to(options);
  flags->json.add_to(options, "--json", "Write counts and rates to this file");
  flags->work.add_to(options);
  options.set_footer(
      "A cloud has no labels. They are assigned by nearest neighbour, so even a perfect map scores "
      "below\n"
      "100. The score of the oracle's cloud is shown for comparison. It is not an upper limit: a "
      "method\n"
      "that also removes static points beside moving ones can have a higher RR or DA.\n"
      "Examples:\n"
      "  raymoval score --sequence data/05 --predictions out/labels\n"
      "  raymoval score --sequence data/05 --cloud static.pcd --voxel 0.1 --protocol erasor "
      "--protocol dynamicmap\n"
      "  raymoval score --truth-map gt_cloud.pcd --cloud static.pcd --protocol dynamicmap\n"
      "  raymoval score data/05 --predictions out/labels --protocol dynamicmap --set "
      "protocol:dynamicmap.distance=0.1\n"
      "  raymoval score --sequence street --predictions "
      "out/street/cells/street/raymoval-online/removals --json score.json");
  return {options.name(), [flags] { return score(*flags); }};
}

}  // namespace raymoval
