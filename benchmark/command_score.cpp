// SPDX-License-Identifier: MIT
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmark/cell.h"
#include "benchmark/commands.h"
#include "benchmark/removal_files.h"
#include "benchmark/results.h"
#include "benchmark/sealed_json.h"
#include "benchmark/sequence_bench.h"
#include "core/files.h"
#include "core/parallel.h"

namespace raymoval {
namespace {

struct ScoreFlags {
  std::string sequence, predictions, json, threads;
  std::vector<std::string> protocols;
  SequenceFlags reading;
  bool quiet = false;
};

std::string result_text(const std::string& name, const ProtocolResult& result) {
  std::string text = "protocol " + name + "\n";
  for (const auto& [count, value] : result.counts) {
    text += "  " + count + " " + std::to_string(value) + "\n";
  }
  for (const Rate& rate : result.rates) {
    text +=
        "  " + rate.name + " " +
        (rate.value ? rate_text(rate.name, *rate.value) : "n/a (" + rate.undefined_reason + ")") +
        "\n";
  }
  for (const std::string& warning : result.warnings) text += "  warning: " + warning + "\n";
  return text;
}

nlohmann::ordered_json score_record(SequenceBench& bench, const ScoreFlags& flags,
                                    Progress& progress) {
  const ScanSource& scans = *bench.sequence().scans;
  progress.begin("reading predictions", scans.size());
  const std::atomic<bool>& cancelled = interrupt_flag();
  const MaskStore masks = read_removals(flags.predictions, scans, [&] {
    progress.advance();
    if (cancelled) throw Cancelled();
  });
  nlohmann::ordered_json record;
  record["schema_version"] = kSchemaVersion;
  record["data"] = bench.sequence().record();
  record["data"]["scans"] = scans.size();
  record["protocols"] = nlohmann::ordered_json::array();
  std::string text;
  for (std::size_t i = 0; i < bench.protocol_count(); ++i) {
    const ProtocolResult result = bench.score(i, masks);
    nlohmann::ordered_json scored;
    scored["name"] = bench.protocol_name(i);
    scored["protocol"] = bench.protocol(i).name();
    scored["version"] = bench.protocol(i).version();
    scored["options"] = to_json(bench.protocol(i).options());
    scored.update(to_json(result));
    record["protocols"].push_back(std::move(scored));
    text += result_text(bench.protocol_name(i), result);
  }
  progress.end();
  print(text);
  return record;
}

ExitCode score(const ScoreFlags& flags) {
  if (flags.sequence.empty()) throw UsageError("--sequence PATH is missing.");
  if (flags.predictions.empty()) {
    throw UsageError("--predictions DIR is missing: the folder with a label file for each scan.");
  }
  Suite suite;
  for (const std::string& protocol : flags.protocols) add_protocol(suite, protocol, "");
  if (suite.protocols.empty()) add_protocol(suite, "erasor", "");
  const int given = parse_threads(flags.threads);
  const int threads = given > 0 ? given : hardware_threads();
  Progress progress(flags.quiet ? ProgressStyle::kQuiet : progress_style_of_stderr());
  SequenceBench bench(open_sequence(flags.sequence, flags.reading.options(),
                                    {threads, &progress, &interrupt_flag()}),
                      suite.protocols, threads, &progress);
  const nlohmann::ordered_json record = score_record(bench, flags, progress);
  if (!flags.json.empty()) write_atomically(flags.json, json_text(record));
  return ExitCode::kDone;
}

}  // namespace

Command add_score_command(CLI::App& program) {
  auto flags = std::make_shared<ScoreFlags>();
  CLI::App* app = program.add_subcommand("score", "Scores label files made by any program");
  app->allow_extras();
  app->add_option("--sequence", flags->sequence, "Sequence folder, ROOT:05, `street`, or a scene")
      ->type_name("PATH");
  app->add_option("--predictions", flags->predictions,
                  "Folder of NNNNNN.label files: 251 to 259 = removed, others kept")
      ->type_name("DIR");
  app->add_option("--protocol", flags->protocols, "Protocol to score by (default: erasor)")
      ->type_name("NAME")
      ->allow_extra_args(false);
  flags->reading.add_to(*app);
  app->add_option("--json", flags->json, "Write counts and rates to this file")->type_name("FILE");
  app->add_option("--threads", flags->threads, "At most so many threads (default: all cores)");
  app->add_flag("--quiet", flags->quiet, "No progress");
  app->footer(
      "Examples:\n"
      "  raymoval score --sequence data/05 --predictions out/labels\n"
      "  raymoval score --sequence street --predictions "
      "out/street/cells/street/raymoval-online/removals --json score.json");
  return {app, [flags] { return score(*flags); }};
}

}  // namespace raymoval
