// SPDX-License-Identifier: MIT
#include "benchmark/result/result_sets.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmark/result/results.h"
#include "benchmark/result/sealed_json.h"
#include "core/files/file_kind.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

Facts facts_of(const std::string& prefix, const ordered_json& object) {
  Facts facts;
  for (const auto& [key, value] : object.items()) facts[prefix + key] = value.dump();
  return facts;
}

Facts cell_identity(const ordered_json& cell) {
  const ordered_json& method = cell.at("method");
  Facts facts = facts_of("parameter ", method.at("parameters"));
  facts["method"] = method.at("name").dump();
  facts["variant"] = method.at("variant").dump();
  if (!cell.contains("data")) return facts;  // A sequence that could not be read.
  // Frames, poses and sensor are part of the fingerprint; here they tell why it differs.
  for (const char* key :
       {"fingerprint", "scans", "frames", "poses", "sensor", "range_m", "label_rule", "drop_ego"}) {
    if (cell.at("data").contains(key)) facts[std::string("data ") + key] = cell["data"][key].dump();
  }
  // Results of earlier versions do not say which way is up; they took z.
  const std::string up = cell.at("data").value("up", "z");
  if (up != "z") facts["data up"] = up;
  return facts;
}

ComparedScore score_of(const ordered_json& scored) {
  ComparedScore score;
  score.protocol = scored.at("name").get<std::string>();
  score.identity = facts_of("option ", scored.at("options"));
  score.identity["protocol"] = scored.at("protocol").dump();
  score.identity["protocol version"] = scored.at("version").dump();
  for (const auto& [name, count] : scored.at("counts").items()) {
    score.counts.emplace_back(name, count.get<std::int64_t>());
  }
  for (const auto& [name, rate] : scored.at("rates").items()) {
    score.rates.push_back({name, {}, ""});
    if (!rate.is_null()) score.rates.back().value = rate.get<double>();
  }
  return score;
}

ComparedCell cell_of(const ordered_json& cell) {
  ComparedCell compared;
  compared.sequence = cell.at("sequence").get<std::string>();
  compared.name = cell.at("name").get<std::string>();
  compared.control = cell.at("method").at("control").get<bool>();
  compared.status = cell.at("status").get<std::string>();
  compared.reason = cell.at("reason").get<std::string>();
  compared.method_version = cell.at("method").at("version").get<std::string>();
  compared.identity = cell_identity(cell);
  for (const ordered_json& scored : cell.at("protocols")) {
    compared.scores.push_back(score_of(scored));
  }
  if (const ordered_json& measured = cell.at("measured"); !measured.is_null()) {
    const ordered_json& mean = measured.at("seconds_per_scan").at("mean");
    if (!mean.is_null()) compared.seconds_per_scan = mean.get<double>();
  }
  return compared;
}

/// "AMD EPYC 7B13, 8 cores, 4 threads used"; empty if the file does not say it.
std::string machine_of(const ordered_json& run) {
  if (!run.contains("machine") || run["machine"].is_null()) return "";
  const ordered_json& machine = run["machine"];
  return machine.value("processor", "an unknown processor") + ", " +
         std::to_string(machine.value("cores", 0)) + " cores, " +
         std::to_string(machine.value("threads", 0)) + " threads used";
}

}  // namespace

std::filesystem::path find_results(const std::string& given) {
  const std::filesystem::path path(given);
  if (is_file(path) && path.extension() != ".json") {
    throw UsageError(given + ": expected a run folder, or its results.json.");
  }
  if (is_file(path)) return path;
  if (!is_folder(path)) {
    throw UsageError(given + ": no such run folder; expected what `raymoval run --out` made.");
  }
  const auto holds = [&](const char* name) { return is_there(path / name); };
  if (holds("results.json")) return path / "results.json";
  // A run that was stopped early may have cells only.
  if (holds("run.json") || holds("cells")) {
    throw UsageError(given +
                     ": has no results.json; the run did not reach its end. Start it again "
                     "with the same --out to go on.");
  }
  throw UsageError(given +
                   ": is no run folder (no run.json in it); expected what `raymoval run --out` "
                   "made.");
}

ResultSet read_result_set(const std::filesystem::path& results) {
  const ordered_json json = read_sealed(results);
  ResultSet set;
  set.control_problems = parse_results(json, results.string()).control_problems;
  try {
    for (const ordered_json& cell : json.at("cells")) set.cells.push_back(cell_of(cell));
    set.machine = machine_of(json.at("run"));
  } catch (const ordered_json::exception& error) {
    throw DataError(results.string() + ": not the results of a run (" + error.what() +
                    "). Run `raymoval run` again with the same --out.");
  }
  return set;
}

void write_reference(const std::filesystem::path& results, const std::filesystem::path& reference,
                     bool with_times) {
  const ResultSet set = read_result_set(results);
  if (!set.control_problems.empty()) {
    throw UsageError(results.string() + ": no reference is made of a run whose controls are off (" +
                     set.control_problems.front() + ").");
  }
  for (const ComparedCell& cell : set.cells) {
    if (cell.status == "ok") continue;
    throw UsageError(results.string() + ": no reference is made of a run with failed cells (" +
                     cell.sequence + " / " + cell.name + ": " + cell.reason + ").");
  }
  const bool timed = std::any_of(set.cells.begin(), set.cells.end(), [](const auto& cell) {
    return cell.seconds_per_scan.has_value();
  });
  if (with_times && !timed) {
    throw UsageError(results.string() +
                     ": has no times that a reference could keep; leave --with-times out.");
  }
  ordered_json json = read_sealed(results);
  json["run"]["build"] = nullptr;
  if (!with_times) json["run"]["machine"] = nullptr;
  for (ordered_json& cell : json["cells"]) {
    if (!with_times) cell["measured"] = nullptr;
    cell["output_tail"] = "";
  }
  write_sealed(reference, std::move(json));
}

}  // namespace raymoval
