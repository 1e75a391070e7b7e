// SPDX-License-Identifier: MIT
#include "benchmark/history/history_json.h"

#include <algorithm>

#include "benchmark/result/record_fields.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/strict_json.h"

namespace raymoval {

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<RecordedScore> score) {
  visitor.field("protocol", score.protocol);
  visitor.field("version", score.version);
  visitor.field("counts", score.counts);
  visitor.field("rates", score.rates);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<RecordedSpeed> speed) {
  visitor.field("yardstick", speed.yardstick);
  visitor.field("rounds", speed.rounds);
  visitor.field("milliseconds", speed.milliseconds);
  visitor.field("median", speed.median);
  visitor.field("min", speed.least);
  visitor.field("max", speed.most);
}

template <class Visitor>
void describe(Visitor& visitor, typename Visitor::template Of<HistoryLine> line) {
  visitor.schema_version();
  visitor.field("commit", line.commit);
  visitor.field("date", line.date);
  visitor.field("version", line.version);
  visitor.field("machine", line.machine);
  visitor.name("sequence", line.sequence);
  visitor.field("fingerprint", line.fingerprint);
  visitor.name("method", line.method);
  visitor.field("method_version", line.method_version);
  visitor.field("status", line.status);
  visitor.field("masks", line.masks);
  visitor.field("protocols", line.scores);
  visitor.nullable("speed", line.speed);
}

namespace {

using std::filesystem::path;

/// What to do about a line of `file` that is none.
std::string remedy_for(const path& file) {
  if (file.extension() == ".json") {
    return " Expected a file *.jsonl, which scripts/record.sh writes: a line for each method.";
  }
  return " Lines are appended by scripts/record.sh and never changed; take the file from the "
         "repository again.";
}

HistoryLine line_from(const std::string& text, const std::string& where,
                      const std::string& remedy) {
  try {
    const nlohmann::ordered_json json = parse_ordered_json(text, where);
    RecordReader(json, where).check_schema_version();
    return read_as<HistoryLine>(json, where);
  } catch (const ConfigurationError& error) {
    throw DataError(std::string(error.what()) + remedy);
  } catch (const FieldError& error) {
    throw DataError(where + ": no line of a history (" + error.what() + ")." + remedy);
  }
}

void read_lines(const path& file, std::vector<HistoryLine>& lines) {
  const std::string text = read_text(file);
  const std::string remedy = remedy_for(file);
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    ++number;
    if (end > begin) {
      lines.push_back(line_from(text.substr(begin, end - begin),
                                file.string() + ":" + std::to_string(number), remedy));
    }
    begin = end + 1;
  }
}

}  // namespace

std::vector<HistoryLine> read_history(const path& folder) {
  if (!is_there(folder)) {
    throw DataError(folder.string() +
                    ": no such folder; expected files *.jsonl, which scripts/record.sh writes.");
  }
  std::vector<path> files;
  if (is_folder(folder)) {
    for (const path& entry : entries_of(folder)) {
      if (entry.extension() == ".jsonl") files.push_back(entry);
    }
  } else {
    files.push_back(folder);
  }
  std::vector<HistoryLine> lines;
  for (const path& file : files) read_lines(file, lines);
  if (lines.empty()) {
    throw DataError(folder.string() +
                    ": holds no history; expected lines in files *.jsonl, which scripts/record.sh "
                    "writes.");
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const HistoryLine& a, const HistoryLine& b) { return a.date < b.date; });
  return lines;
}

nlohmann::ordered_json to_json(const std::vector<HistoryTrack>& tracks) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const HistoryTrack& track : tracks) {
    nlohmann::ordered_json events = nlohmann::ordered_json::array();
    for (const HistoryEvent& event : track.events) {
      nlohmann::ordered_json json = written(event.line);
      json.erase("schema_version");
      json["first"] = event.is_first;
      json["changes"] = event.changes;
      json["moved"] = nlohmann::ordered_json::object();
      for (const auto& [rate, by] : event.moved) json["moved"][rate] = by;
      events.push_back(std::move(json));
    }
    list.push_back({{"sequence", track.sequence},
                    {"method", track.method},
                    {"machine", track.machine},
                    {"events", std::move(events)}});
  }
  return {{"schema_version", kSchemaVersion}, {"tracks", std::move(list)}};
}

}  // namespace raymoval
