// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>

namespace raymoval {

/// How progress is shown on standard error.
enum class ProgressStyle {
  kQuiet,     ///< Not at all.
  kLog,       ///< A line every half minute.
  kTerminal,  ///< One line, rewritten, with an estimate of the time left.
};

/// `kTerminal` if standard error is a terminal, else `kLog`.
ProgressStyle progress_style_of_stderr();

/// The state of a task.
struct ProgressState {
  std::string context;    ///< The larger task that it belongs to; may be empty.
  std::string task;       ///< Empty before the first task.
  std::size_t done = 0;   ///< Steps.
  std::size_t total = 0;  ///< Steps; 0 when the task has ended.
  std::size_t tasks = 0;  ///< Number of tasks begun; distinguishes two tasks of one name.

  bool operator==(const ProgressState&) const = default;
};

/// Shows the progress of a long task. Thread-safe.
class Progress {
 public:
  /// @param stream receives the text; must outlive this object
  explicit Progress(ProgressStyle style = ProgressStyle::kQuiet, std::FILE* stream = stderr)
      : style_(style), stream_(stream) {}
  [[nodiscard]] ProgressStyle style() const { return style_; }
  /// The larger task of the following tasks, such as "[2/10] octomap:ground on town", which is
  /// printed before each of them; may be empty.
  void set_context(const std::string& context);
  [[nodiscard]] std::string context();
  /// Starts a task of `total` steps, such as "raymoval:online on 05".
  void begin(const std::string& task, std::size_t total);
  void advance(std::size_t steps = 1);
  /// Ends the task; on a terminal its line is cleared.
  void end();
  /// The state of the task, for callers that show it themselves.
  [[nodiscard]] ProgressState state();
  /// Prints a separate line, not mixed with a progress line.
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
