// SPDX-License-Identifier: MIT
#include "benchmark/process/method_process.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/sealed_json.h"
#include "benchmark/suite/sequence_place.h"
#include "core/files/descriptor.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "methods/external/working_folder.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

// Descriptors of the child.
constexpr int kTaskFile = 3;  ///< JSON: what to run.
constexpr int kAnswerFile =
    4;  ///< A line of JSON, then the masks' bits, scan by scan, then reasons.
constexpr int kProgressFile = 5;

/// A file that lives in memory and vanishes with the last process that has it.
Descriptor memory_file(const char* name) {
  Descriptor file(::memfd_create(name, MFD_CLOEXEC));
  if (!file.valid()) {
    throw DataError("no memory for the answer of a method (" +
                    std::generic_category().message(errno) + ").");
  }
  return file;
}

void write_all(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t put = ::write(file, content.data(), content.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) {
      throw DataError("the answer cannot be handed over (" +
                      std::generic_category().message(errno) + ").");
    }
    content.remove_prefix(static_cast<std::size_t>(put));
  }
}

/// Up to `size` bytes from `offset`.
std::string read_some(int file, std::size_t offset, std::size_t size) {
  std::string content(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got =
        ::pread(file, content.data() + done, size - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  content.resize(done);
  return content;
}

std::size_t size_of(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 ? static_cast<std::size_t>(status.st_size) : 0;
}

// The task as JSON.

ordered_json task_record(const MethodTask& task, const SequenceRequest& place) {
  ordered_json record;
  record["sequence"] = place_record(place);
  record["name"] = task.request->name;
  record["method"] = task.request->method.address();
  record["parameters"] = to_json(task.request->method.configuration);
  record["threads"] = task.threads;
  record["with_reasons"] = task.with_reasons;
  record["progress"] =
      static_cast<int>(task.progress != nullptr ? task.progress->style() : ProgressStyle::kQuiet);
  if (task.progress != nullptr) record["progress_context"] = task.progress->context();
  return record;
}

MethodRequest request_from(const ordered_json& record, const MethodRegistry& registry) {
  MethodRequest request;
  request.name = record.at("name").get<std::string>();
  request.method = registry.configure(record.at("method").get<std::string>());
  const MethodEntry& entry = *request.method.entry;
  for (const auto& [key, value] : record.at("parameters").items()) {
    const ParameterSpec& spec = find_parameter(entry.name, entry.parameters, key);
    set_parameter(request.method.configuration, key, checked_value(entry.name, spec, value));
  }
  return request;
}

// The answer: a line of JSON, then bits.

std::string packed(const Mask& mask) {
  std::string bits((mask.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0) bits[i / 8] = static_cast<char>(bits[i / 8] | (1 << (i % 8)));
  }
  return bits;
}

Mask unpacked(const std::string& bits, std::size_t points) {
  Mask mask(points);
  for (std::size_t i = 0; i < points; ++i) {
    mask[i] = static_cast<std::uint8_t>(static_cast<unsigned char>(bits[i / 8]) >> (i % 8) & 1U);
  }
  return mask;
}

ordered_json loaded_record(const LoadedData& loaded) {
  ordered_json record;
  record["settings"] = loaded.settings;
  record["scans"] = loaded.scans;
  record["labels"] = loaded.labels;
  record["change"] = loaded.change;
  return record;
}

LoadedData loaded_from(const ordered_json& record) {
  LoadedData loaded;
  loaded.settings = record.at("settings").get<std::string>();
  loaded.scans = record.at("scans").get<std::vector<std::string>>();
  loaded.labels = record.at("labels").get<std::vector<std::string>>();
  loaded.change = record.at("change").get<std::string>();
  return loaded;
}

void write_answer(int file, const MethodAnswer& answer) {
  ordered_json head;
  head["status"] = answer.status;
  head["reason"] = answer.reason;
  head["measured"] = to_json(answer.measured);
  head["points"] = ordered_json::array();
  for (std::size_t i = 0; i < answer.masks.size(); ++i) {
    head["points"].push_back(answer.masks.point_count(i));
  }
  head["digest"] = mask_digest(answer.masks);
  head["reasons"] = answer.reasons.sentences;
  if (answer.loaded) head["loaded"] = loaded_record(*answer.loaded);
  write_all(file, head.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  for (std::size_t i = 0; i < answer.masks.size(); ++i) {
    write_all(file, packed(answer.masks.get(i)));
  }
  for (const std::vector<std::uint8_t>& codes : answer.reasons.codes) {
    write_all(file, {reinterpret_cast<const char*>(codes.data()), codes.size()});
  }
}

/// @throws nlohmann::json::exception or MethodError if it is not whole
MethodAnswer read_answer(int file) {
  const std::size_t size = size_of(file);
  std::string head;
  std::size_t offset = 0;
  for (bool whole = false; !whole;) {
    const std::string piece = read_some(file, offset, 65536);
    if (piece.empty()) throw MethodError("the answer is cut off");
    const std::size_t end = piece.find('\n');
    whole = end != std::string::npos;
    head += piece.substr(0, end);
    offset += whole ? end + 1 : piece.size();
  }
  const ordered_json json = ordered_json::parse(head);
  MethodAnswer answer;
  answer.status = json.at("status").get<std::string>();
  answer.reason = json.at("reason").get<std::string>();
  answer.measured = measurement_from(json.at("measured"));
  if (json.contains("loaded")) answer.loaded = loaded_from(json.at("loaded"));
  const auto points = json.at("points").get<std::vector<std::size_t>>();
  answer.masks = MaskStore(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i] / 8 > size) throw MethodError("the answer is cut off");
    const std::size_t bytes = (points[i] + 7) / 8;
    const std::string bits = read_some(file, offset, bytes);
    if (bits.size() < bytes) throw MethodError("the answer is cut off");
    answer.masks.set(i, unpacked(bits, points[i]));
    offset += bytes;
  }
  if (mask_digest(answer.masks) != json.at("digest")) throw MethodError("the answer is damaged");
  answer.reasons.sentences = json.at("reasons").get<std::vector<std::string>>();
  for (std::size_t i = 0; i < points.size() && !answer.reasons.sentences.empty(); ++i) {
    const std::string codes = read_some(file, offset, points[i]);
    if (codes.size() < points[i]) throw MethodError("the answer is cut off");
    answer.reasons.codes.emplace_back(codes.begin(), codes.end());
    offset += points[i];
  }
  return answer;
}

std::string mib_text(double mib) {
  return fixed_text(mib, 0) + " MiB";
}

/// What became of a child that gave no answer.
MethodAnswer no_answer(const ChildEnd& end, const ChildLimits& limits) {
  MethodAnswer answer;
  answer.status = "failed";
  switch (end.kind) {
    case ChildEnd::Kind::kCancelled:
      throw Cancelled();
    case ChildEnd::Kind::kTimeout:
      answer.status = "timeout";
      answer.reason = "did not finish within " + fixed_text(limits.seconds, 0) +
                      " s (see --time-limit) and was ended";
      break;
    case ChildEnd::Kind::kOutOfMemory:
      answer.status = "out_of_memory";
      answer.reason = "used more than " + mib_text(limits.memory_mib) +
                      " of memory (see --memory-limit) and was ended";
      break;
    case ChildEnd::Kind::kSignalled:
      answer.reason = "crashed: " + signal_text(end.code);
      if (end.code != SIGKILL) break;
      // Nobody here sent it. The system does when memory runs out, and then this was the largest.
      if (end.largest_mib > 0.5 * machine_memory_mib()) answer.status = "out_of_memory";
      answer.reason = "was killed from outside when it had " + mib_text(end.largest_mib) +
                      " of memory: by the system if memory ran out, or by somebody";
      break;
    case ChildEnd::Kind::kExited:
      answer.reason = "ended with exit code " + std::to_string(end.code) + " and without an answer";
      break;
  }
  return answer;
}

/// The run that this process belongs to was killed: what the method started goes with it.
void on_orphaned(int) {
  ::kill(0, SIGKILL);  // Its whole process group, itself included.
}

/// A child that is ended cannot remove the working folder of an external method itself.
struct Tidy {
  const MethodEntry& entry;
  ~Tidy() {
    if (!entry.manifest.empty()) remove_abandoned_working_folders();
  }
};

}  // namespace

MethodAnswer run_method_apart(const MethodTask& task, const SequenceRequest& place,
                              const ChildLimits& limits) {
  const Descriptor task_file = memory_file("task");
  const Descriptor answer_file = memory_file("answer");
  write_all(task_file.get(), json_text(task_record(task, place)));
  if (task.progress != nullptr) task.progress->end();
  const Tidy tidy{*task.request->method.entry};
  const ChildEnd end = run_child({{kMethodCommand},
                                  {{task_file.get(), kTaskFile},
                                   {answer_file.get(), kAnswerFile},
                                   {STDERR_FILENO, kProgressFile}},
                                  limits,
                                  task.cancel});
  MethodAnswer answer;
  if (end.kind == ChildEnd::Kind::kExited && end.code == 0) {
    try {
      answer = read_answer(answer_file.get());
    } catch (const std::exception& error) {
      answer.status = "failed";
      answer.reason = std::string("gave no readable answer (") + error.what() + ")";
    }
  } else {
    answer = no_answer(end, limits);
  }
  if (answer.status != "ok") answer.output_tail = end.output_tail;
  return answer;
}

void serve_method(const MethodRegistry& registry) {
  if (::lseek(kTaskFile, 0, SEEK_SET) != 0 || ::lseek(kAnswerFile, 0, SEEK_SET) != 0) {
    throw UsageError(std::string("'") + kMethodCommand +
                     "' is what `raymoval run` starts by itself. Use `raymoval run`.");
  }
  std::signal(SIGTERM, on_orphaned);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // Until here it was SIGKILL, see run_child.
  const ordered_json record = ordered_json::parse(read_some(kTaskFile, 0, size_of(kTaskFile)));
  std::FILE* terminal = ::fdopen(kProgressFile, "w");
  Progress progress(terminal != nullptr
                        ? static_cast<ProgressStyle>(record.at("progress").get<int>())
                        : ProgressStyle::kQuiet,
                    terminal != nullptr ? terminal : stderr);
  progress.set_context(record.value("progress_context", ""));
  const SequenceRequest place = place_from(record.at("sequence"));
  const MethodRequest request = request_from(record, registry);
  const int threads = record.at("threads").get<int>();
  MethodAnswer answer;
  try {
    // The parent compares what is loaded here with what it has checked itself.
    const WatchedSequence data =
        watched(open_sequence(place.path, place.options, {threads, &progress, nullptr, false}));
    answer = run_method({&data.sequence, &request, threads, &progress, nullptr,
                         record.at("with_reasons").get<bool>()});
    answer.loaded = data.loaded();
  } catch (const Error& error) {
    answer.status = "bad_data";
    answer.reason = error.what();
  }
  progress.end();
  write_answer(kAnswerFile, answer);
  // Not by way of destructors: a method's threads or globals cannot hold up what is done.
  std::fflush(nullptr);
  ::_exit(0);
}

}  // namespace raymoval
