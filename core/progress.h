// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>

namespace raymoval {

/// How progress is told on standard error.
enum class ProgressStyle {
  kQuiet,     ///< Not at all.
  kLog,       ///< A line every half minute.
  kTerminal,  ///< One line, rewritten, with an estimate of the time left.
};

/// `kTerminal` if standard error is a terminal, else `kLog`.
ProgressStyle progress_style_of_stderr();

/// How far a task is.
struct ProgressState {
  std::string context;    ///< What it is part of; may be empty.
  std::string task;       ///< Empty before the first task.
  std::size_t done = 0;   ///< Steps.
  std::size_t total = 0;  ///< Steps; 0 when the task has ended.
  std::size_t tasks = 0;  ///< Tasks begun so far: it tells a task from the next one of its name.

  bool operator==(const ProgressState&) const = default;
};

/// Tells how far a long task is. Thread-safe.
class Progress {
 public:
  /// @param stream where it is told; stays open as long as this lives
  explicit Progress(ProgressStyle style = ProgressStyle::kQuiet, std::FILE* stream = stderr)
      : style_(style), stream_(stream) {}
  [[nodiscard]] ProgressStyle style() const { return style_; }
  /// What the following tasks are part of, such as "[2/10] octomap:ground on town"; stands before
  /// each of them. Empty: nothing.
  void set_context(const std::string& context);
  [[nodiscard]] std::string context();
  /// Starts a task of `total` steps, such as "raymoval:online on 05".
  void begin(const std::string& task, std::size_t total);
  void advance(std::size_t steps = 1);
  /// Ends the task; on a terminal its line is cleared.
  void end();
  /// How far the task is, for those who show it themselves.
  [[nodiscard]] ProgressState state();
  /// Prints a line of its own, not mixed with a progress line.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  void print_terminal(Clock::time_point now);
  void print_log(Clock::time_point now);
  [[nodiscard]] std::string status(Clock::time_point now) const;
  [[nodiscard]] std::string with_context(const std::string& line) const;

  ProgressStyle style_;
  std::FILE* stream_;
  std::mutex mutex_;
  std::string context_;
  std::string task_;
  std::size_t total_ = 0;
  std::size_t done_ = 0;
  std::size_t tasks_ = 0;
  Clock::time_point started_, printed_;
};

}  // namespace raymoval
