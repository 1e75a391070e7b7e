// SPDX-License-Identifier: MIT
#include "benchmark/result/speed/speed_record.h"

#include <fmt/format.h>

#include <utility>

#include "benchmark/result/record_fields.h"
#include "core/files/files.h"

namespace raymoval {

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<SpeedFigure> figure) {
  visitor.field("milliseconds", figure.milliseconds);
  visitor.nested("relative", [&](auto& relative) {
    relative.field("median", figure.median);
    relative.field("min", figure.least);
    relative.field("max", figure.most);
  });
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<CellSpeed> cell) {
  visitor.name("method", cell.method);
  visitor.field("whole", cell.whole);
  visitor.field("load", cell.load);
  visitor.field("run", cell.run);
  visitor.field("score", cell.score);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<SpeedRecord> speed) {
  visitor.schema_version();
  visitor.field("scene", speed.scene);
  visitor.field("scans", speed.scans);
  visitor.field("threads", speed.threads);
  visitor.field("repetitions", speed.repetitions);
  visitor.nested("yardstick", [&](auto& yardstick) {
    yardstick.field("name", speed.yardstick);
    yardstick.field("milliseconds", speed.yardstick_milliseconds);
  });
  visitor.optional("processor", speed.processor);
  visitor.optional("commit", speed.commit);
  visitor.field("cells", speed.cells);
}

SpeedRecord read_speed(const std::filesystem::path& file) {
  const std::string name = file.string();
  nlohmann::ordered_json json;
  try {
    json = nlohmann::ordered_json::parse(read_text(file));
  } catch (const nlohmann::json::exception& error) {
    throw DataError(name + ": this is not JSON (" + error.what() +
                    "); expected the speed.json of scripts/benchmark.sh.");
  }
  RecordReader(json, name).check_schema_version();
  return read_as<SpeedRecord>(json, name);
}

void write_speed(const std::filesystem::path& file, const SpeedRecord& speed) {
  write_atomically(file, json_text(to_json(speed)));
}

namespace {

const CellSpeed* find_cell(const SpeedRecord& speed, const std::string& method) {
  for (const CellSpeed& cell : speed.cells) {
    if (cell.method == method) return &cell;
  }
  return nullptr;
}

/// A sentence for each condition under which the two were not measured alike.
std::vector<std::string> unlike(const SpeedRecord& run, const SpeedRecord& reference) {
  std::vector<std::string> sentences;
  const auto check = [&](const char* what, const auto& ours, const auto& theirs) {
    if (ours == theirs) return;
    sentences.push_back(fmt::format("{} is {}, the reference has {}", what, ours, theirs));
  };
  check("the scene", run.scene, reference.scene);
  check("the number of scans", run.scans, reference.scans);
  check("the number of threads", run.threads, reference.threads);
  check("the yardstick", run.yardstick, reference.yardstick);
  if (reference.cells.empty()) sentences.emplace_back("the reference has no cell");
  for (const CellSpeed& cell : reference.cells) {
    if (!(cell.whole.median > 0.0))
      sentences.push_back(cell.method + ": the reference has no time");
    if (find_cell(run, cell.method) != nullptr) continue;
    sentences.push_back(cell.method + " is missing in the run");
  }
  return sentences;
}

void compare_cell(const CellSpeed& run, const CellSpeed& reference, double band,
                  SpeedComparison& result) {
  const std::pair<const char*, SpeedFigure CellSpeed::*> parts[] = {
      {"the whole cell", &CellSpeed::whole},
      {"loading", &CellSpeed::load},
      {"the method", &CellSpeed::run},
      {"scoring", &CellSpeed::score}};
  std::string line = run.method + ":";
  for (const auto& [name, part] : parts) {
    const double after = (run.*part).median, before = (reference.*part).median;
    const bool judged = before >= kJudgedShare * reference.whole.median;
    if (!judged) continue;
    const double ratio = after / before;
    line += fmt::format("{} {} {:.2f}", line.back() == ':' ? "" : ",", name, ratio);
    if (!(ratio > band)) continue;
    result.worse.push_back(fmt::format(
        "{}: {} takes {:.2f} times the reference ({:.3f} yardsticks, was {:.3f}), more than {:g}",
        run.method, name, ratio, after, before, band));
  }
  result.lines.push_back(line);
}

}  // namespace

ExitCode SpeedComparison::verdict() const {
  if (!incomparable.empty()) return ExitCode::kCannotDo;
  return worse.empty() ? ExitCode::kDone : ExitCode::kWorse;
}

SpeedComparison compare_speed(const SpeedRecord& run, const SpeedRecord& reference, double band) {
  SpeedComparison result;
  result.incomparable = unlike(run, reference);
  if (!result.incomparable.empty()) return result;
  for (const CellSpeed& cell : reference.cells) {
    compare_cell(*find_cell(run, cell.method), cell, band, result);
  }
  for (const CellSpeed& cell : run.cells) {
    if (find_cell(reference, cell.method) != nullptr) continue;
    result.lines.push_back(cell.method + ": not in the reference, not compared");
  }
  return result;
}

std::string speed_text(const SpeedComparison& comparison) {
  std::string text;
  const auto add = [&](const char* heading, const std::vector<std::string>& lines) {
    if (!lines.empty()) text += std::string(heading) + ":\n";
    for (const std::string& line : lines) text += "  " + line + "\n";
  };
  add("Not comparable", comparison.incomparable);
  add("Worse", comparison.worse);
  add("Times the reference, in yardsticks", comparison.lines);
  const char* const verdicts[] = {"no regression", "worse", "not comparable"};
  return text + verdicts[static_cast<int>(comparison.verdict())] + ".\n";
}

}  // namespace raymoval
