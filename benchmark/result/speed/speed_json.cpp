// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "benchmark/result/record_fields.h"
#include "benchmark/result/speed/speed_record.h"
#include "core/error.h"
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
    throw DataError(name + ": this is no JSON (" + error.what() +
                    "); expected the speed.json of scripts/benchmark.sh.");
  }
  RecordReader(json, name).check_schema_version();
  return read_as<SpeedRecord>(json, name);
}

void write_speed(const std::filesystem::path& file, const SpeedRecord& speed) {
  write_atomically(file, json_text(written(speed)));
}

}  // namespace raymoval
