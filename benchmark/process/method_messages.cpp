// SPDX-License-Identifier: MIT
#include "benchmark/process/method_messages.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/suite/suite_json.h"
#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/scan/packed_mask.h"

namespace raymoval {

using nlohmann::json;

// LoadedData without the names of the scans, which the parent already has.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LoadedData, settings, scans, labels, change)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MethodOptions, threads, with_reasons, with_confidence)

namespace {

/// The written form of an order.
struct OrderMessage {
  json place;
  std::string name, method;
  json parameters;
  MethodOptions options = {};
  std::vector<double> up = {};  ///< x, y and z.
  int up_source = 0;
  int progress = static_cast<int>(ProgressStyle::kQuiet);
  std::string progress_context = {};
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OrderMessage, place, name, method, parameters, options, up,
                                   up_source, progress, progress_context)

/// The head of an answer, before its masks, reasons and confidence.
struct AnswerHead {
  std::string status, reason;
  json measured;
  std::vector<std::size_t> points;  ///< Of each scan.
  std::string digest;               ///< Of the masks.
  std::vector<std::string> reasons;
  bool has_confidence = false;
  std::vector<LoadedData> loaded;  ///< One or none.
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AnswerHead, status, reason, measured, points, digest, reasons,
                                   has_confidence, loaded)

/// Writes a file piece by piece.
class MessageWriter {
 public:
  explicit MessageWriter(int file) : file_(file) {}

  void put(std::string_view piece) {
    if (!write_at(file_, piece, offset_)) {
      throw DataError(fmt::format("a message between two processes cannot be written ({}).",
                                  std::generic_category().message(errno)));
    }
    offset_ += piece.size();
  }
  /// The size of the text as a number of 8 bytes, then the text.
  void put_json(const json& message) {
    const std::string text = message.dump(-1, ' ', false, json::error_handler_t::replace);
    const std::uint64_t size = text.size();
    put({reinterpret_cast<const char*>(&size), sizeof size});
    put(text);
  }

 private:
  int file_;
  std::uint64_t offset_ = 0;
};

/// Reads what MessageWriter wrote.
class MessageReader {
 public:
  explicit MessageReader(int file) : file_(file) {
    struct stat status {};
    if (::fstat(file, &status) == 0) left_ = static_cast<std::uint64_t>(status.st_size);
  }

  std::string take(std::uint64_t size) {
    std::string piece;
    if (size <= left_) piece = read_at(file_, static_cast<std::size_t>(size), offset_);
    if (piece.size() < size) throw MethodError("the answer is truncated");
    offset_ += size;
    left_ -= size;
    return piece;
  }
  json take_json() {
    std::uint64_t size = 0;
    std::memcpy(&size, take(sizeof size).data(), sizeof size);
    return json::parse(take(size));
  }

 private:
  int file_;
  std::uint64_t offset_ = 0, left_ = 0;
};

}  // namespace

void write_order(int file, const MethodTask& task) {
  const ConfiguredMethod& method = task.request->method;
  const UpDirection up = task.sequence->up();
  OrderMessage message{to_json(*task.place), task.request->name, method.address(),
                       to_json(method.configuration), task.options};
  message.up = {up.direction.x(), up.direction.y(), up.direction.z()};
  message.up_source = static_cast<int>(up.source);
  if (task.progress != nullptr) {
    message.progress = static_cast<int>(task.progress->style());
    message.progress_context = task.progress->context();
  }
  MessageWriter(file).put_json(message);
}

MethodOrder read_order(int file, const MethodRegistry& registry) {
  const auto message = MessageReader(file).take_json().get<OrderMessage>();
  MethodRequest request{message.name, registry.configure(message.method)};
  const MethodEntry& entry = *request.method.entry;
  for (const auto& [key, value] : message.parameters.items()) {
    const ParameterSpec& spec = find_parameter(entry.name, entry.parameters, key);
    set_parameter(request.method.configuration, key, checked_value(entry.name, spec, value));
  }
  MethodOrder order{place_from(message.place), std::move(request), message.options};
  order.up = {{message.up.at(0), message.up.at(1), message.up.at(2)},
              static_cast<UpDirection::Source>(message.up_source)};
  order.progress = static_cast<ProgressStyle>(message.progress);
  order.progress_context = message.progress_context;
  return order;
}

void write_answer(int file, const MethodAnswer& answer) {
  AnswerHead head{status_name(answer.status), answer.reason,
                  to_json(answer.measured),   {},
                  mask_digest(answer.masks),  answer.reasons.sentences,
                  !answer.confidence.empty(), {}};
  for (std::size_t i = 0; i < answer.masks.size(); ++i) {
    head.points.push_back(answer.masks.point_count(i));
  }
  if (answer.loaded) head.loaded.push_back(*answer.loaded);
  MessageWriter writer(file);
  writer.put_json(head);
  for (std::size_t i = 0; i < answer.masks.size(); ++i) {
    writer.put(packed_mask(answer.masks.get(i)));
  }
  for (const std::vector<std::uint8_t>& codes : answer.reasons.codes) {
    writer.put({reinterpret_cast<const char*>(codes.data()), codes.size()});
  }
  const ScanSpool& steps = answer.confidence.steps;
  for (std::size_t i = 0; i < steps.size(); ++i) writer.put(steps.get(i));
}

MethodAnswer read_answer(int file) {
  MessageReader reader(file);
  const auto head = reader.take_json().get<AnswerHead>();
  MethodAnswer answer;
  const auto status = status_called(head.status);
  if (!status) throw MethodError("the answer is damaged");
  answer.status = *status;
  answer.reason = head.reason;
  answer.measured = read_as<Measurement>(head.measured, "the answer");
  if (!head.loaded.empty()) answer.loaded = head.loaded.front();
  answer.masks = MaskStore(head.points.size());
  for (std::size_t i = 0; i < head.points.size(); ++i) {
    const std::uint64_t bytes = head.points[i] / 8 + (head.points[i] % 8 != 0 ? 1 : 0);
    answer.masks.set(i, unpacked_mask(reader.take(bytes), head.points[i]));
  }
  if (mask_digest(answer.masks) != head.digest) throw MethodError("the answer is damaged");
  answer.reasons.sentences = head.reasons;
  for (const std::size_t points : head.points) {
    if (head.reasons.empty()) break;
    const std::string codes = reader.take(points);
    answer.reasons.codes.emplace_back(codes.begin(), codes.end());
  }
  for (const std::size_t points : head.points) {
    if (head.has_confidence) answer.confidence.steps.append(reader.take(points));
  }
  return answer;
}

}  // namespace raymoval
