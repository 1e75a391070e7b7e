// SPDX-License-Identifier: MIT
#include "benchmark/process/method_process.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <utility>

#include "benchmark/process/method_messages.h"
#include "core/files/descriptor_io.h"
#include "core/files/scratch_folder.h"
#include "core/process/proc_files.h"
#include "core/process/process_family.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {
namespace {

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
    // The parent compares the data that is loaded here with the data that it has checked.
    Sequence sequence = open_sequence(order.place.path, order.place.options,
                                      {order.options.threads, &progress, nullptr, false});
    if (sequence.up_choice) sequence.up_choice = std::make_shared<const UpChoice>(order.up);
    const WatchedSequence data = watched(std::move(sequence));
    answer = run_method({&data.sequence, &order.request, order.options, &progress});
    answer.loaded = data.loaded();
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
