// SPDX-License-Identifier: MIT
#include "benchmark/process/method_process.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "benchmark/process/checked_sink.h"
#include "benchmark/process/method_run.h"
#include "benchmark/result/result_fields.h"
#include "benchmark/suite/suite.h"
#include "benchmark/suite/suite_json.h"
#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/scratch_folder.h"
#include "core/process/proc_files.h"
#include "core/process/process_family.h"
#include "core/progress.h"
#include "core/scan/mask_store.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MethodOptions, threads, with_reasons, with_confidence)

namespace {

/// The message to a child process that runs a method.
struct MethodOrder {
  SequenceRequest place;  ///< The sequence, and how the child opens it.
  MethodRequest request;  ///< The child needs its name, method and parameters only.
  MethodOptions options = {};
  /// The up direction of the sequence, which is costly: it is found by reading scans.
  UpDirection up = {};
  ProgressStyle progress = ProgressStyle::kQuiet;
  std::string progress_context = {};
};

/// The written form of an order.
struct OrderMessage {
  nlohmann::json place;
  std::string name, method;
  nlohmann::json parameters;
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
  nlohmann::json measured;
  std::vector<std::size_t> points;  ///< Of each scan.
  std::string digest;               ///< Of the masks.
  std::vector<std::string> reasons;
  bool has_confidence = false;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AnswerHead, status, reason, measured, points, digest, reasons,
                                   has_confidence)

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
  void put_json(const nlohmann::json& message) {
    const std::string text = message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
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
  nlohmann::json take_json() {
    std::uint64_t size = 0;
    std::memcpy(&size, take(sizeof size).data(), sizeof size);
    return nlohmann::json::parse(take(size));
  }

 private:
  int file_;
  std::uint64_t offset_ = 0, left_ = 0;
};

// Both messages are files, because a full pipe would block the writing process.

/// @param task with a place
/// @throws DataError if `file` cannot be written
void write_order(int file, const MethodTask& task) {
  const ConfiguredMethod& method = task.request->method;
  const UpDirection up = task.sequence->up();
  OrderMessage message{to_json(*task.place), task.request->name, method.address(),
                       raymoval::to_json(method.configuration), task.options};
  message.up = {up.direction.x(), up.direction.y(), up.direction.z()};
  message.up_source = static_cast<int>(up.source);
  if (task.progress != nullptr) {
    message.progress = static_cast<int>(task.progress->style());
    message.progress_context = task.progress->context();
  }
  MessageWriter(file).put_json(message);
}

/// @throws nlohmann::json::exception or MethodError if the order is not whole
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

/// @throws DataError if `file` cannot be written
void write_answer(int file, const MethodAnswer& answer) {
  AnswerHead head{status_name(answer.status), answer.reason,
                  to_json(answer.measured),   {},
                  mask_digest(answer.masks),  answer.reasons.sentences,
                  !answer.confidence.empty()};
  for (std::size_t i = 0; i < answer.masks.size(); ++i) {
    head.points.push_back(answer.masks.point_count(i));
  }
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

/// @throws nlohmann::json::exception or MethodError if the answer is not whole, since a method may
/// write to any file of its process
MethodAnswer read_answer(int file) {
  MessageReader reader(file);
  const auto head = reader.take_json().get<AnswerHead>();
  MethodAnswer answer;
  const auto status = status_called(head.status);
  if (!status) throw MethodError("the answer is damaged");
  answer.status = *status;
  answer.reason = head.reason;
  answer.measured = read_as<Measurement>(head.measured, "the answer");
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

// Descriptors of the child.
constexpr int kOrderFile = 3;
constexpr int kAnswerFile = 4;
constexpr int kProgressFile = 5;

[[noreturn]] void refuse_to_serve() {
  throw UsageError(fmt::format("'{}' is what `raymoval run` starts by itself. Use `raymoval run`.",
                               kMethodCommand));
}

/// A shell may have left other open files under these numbers, which hold no order.
MethodOrder order_at_hand(const MethodRegistry& registry) {
  try {
    return read_order(kOrderFile, registry);
  } catch (const MethodError&) {
    refuse_to_serve();
  }
}

/// The answer for a child that gave none.
MethodAnswer no_answer(const ChildEnd& end, const ChildLimits& limits) {
  MethodAnswer answer;
  answer.status = CellStatus::kFailed;
  switch (end.kind) {
    case ChildEnd::Kind::kCancelled:
      throw Cancelled();
    case ChildEnd::Kind::kNotStarted:
      throw DataError(not_started_text(end.code));
    case ChildEnd::Kind::kTimeout:
      answer.status = CellStatus::kTimeout;
      answer.reason = fmt::format("did not finish within {} s (see --time-limit) and was ended",
                                  number_text(limits.seconds));
      break;
    case ChildEnd::Kind::kOutOfMemory:
      answer.status = CellStatus::kOutOfMemory;
      answer.reason =
          fmt::format("used more than {:.0f} MiB of memory (see --memory-limit) and was ended",
                      limits.memory_mib);
      if (!end.memory_note.empty()) answer.reason += "." + end.memory_note;
      break;
    case ChildEnd::Kind::kOutOfDisk:
      throw InternalError("a method has no limit on its folder");
    case ChildEnd::Kind::kSignalled:
      answer.reason = (asking_signal(end) != 0 ? "was ended from outside by " : "crashed: ") +
                      signal_text(end.code);
      if (end.code != SIGKILL) break;
      // This program did not send the signal. The system sends it to the largest process when
      // memory runs out.
      if (end.largest_mib > 0.5 * machine_memory_mib()) answer.status = CellStatus::kOutOfMemory;
      answer.reason = fmt::format(
          "was killed from outside when it had {:.0f} MiB of memory: by the system if memory ran "
          "out, or by a user",
          end.largest_mib);
      break;
    case ChildEnd::Kind::kExited:
      answer.reason = fmt::format("ended with exit code {} and without an answer", end.code);
      break;
  }
  return answer;
}

/// Removes the files that an ended process left: an unpacked recording, and the working folder of
/// an external method.
struct Tidy {
  ~Tidy() { remove_abandoned_scratch_folders(); }
};

}  // namespace

MethodAnswer run_method_in_child(const MethodTask& task) {
  const Descriptor order_file = memory_file("order");
  const Descriptor answer_file = memory_file("answer");
  write_order(order_file.get(), task);
  if (task.progress != nullptr) task.progress->end();
  const Tidy tidy;
  ChildSetup setup;
  setup.arguments = {"raymoval", kMethodCommand};
  setup.descriptors = {{order_file.get(), kOrderFile},
                       {answer_file.get(), kAnswerFile},
                       {STDERR_FILENO, kProgressFile}};
  setup.limits = task.limits;
  setup.cancel = task.cancel;
  const ChildEnd end = run_child(setup);
  MethodAnswer answer;
  if (end.kind == ChildEnd::Kind::kExited && end.code == 0) {
    try {
      answer = read_answer(answer_file.get());
    } catch (const std::exception& error) {
      answer = {};
      answer.status = CellStatus::kFailed;
      answer.reason = std::string("gave no readable answer (") + error.what() + ")";
    }
  } else {
    answer = no_answer(end, task.limits);
  }
  if (answer.status != CellStatus::kOk) answer.output_tail = end.output_tail;
  return answer;
}

void serve_method(const MethodRegistry& registry) {
  if (::lseek(kOrderFile, 0, SEEK_SET) != 0 || ::lseek(kAnswerFile, 0, SEEK_SET) != 0) {
    refuse_to_serve();
  }
  end_family_with_parent();
  const MethodOrder order = order_at_hand(registry);
  std::FILE* terminal = ::fdopen(kProgressFile, "w");
  Progress progress(terminal != nullptr ? order.progress : ProgressStyle::kQuiet,
                    terminal != nullptr ? terminal : stderr);
  progress.set_context(order.progress_context);
  MethodAnswer answer;
  try {
    Sequence sequence = open_sequence(order.place.path, order.place.options,
                                      {order.options.threads, &progress, nullptr});
    if (sequence.up_choice) sequence.up_choice = std::make_shared<const UpChoice>(order.up);
    answer = run_method({&sequence, &order.request, order.options, &progress});
  } catch (const Error& error) {
    answer.status = CellStatus::kBadData;
    answer.reason = error.what();
  }
  progress.end();
  write_answer(kAnswerFile, answer);
  // Ends without destructors, so that threads or globals of a method cannot delay the end.
  std::fflush(nullptr);
  ::_exit(0);
}

}  // namespace raymoval
