// SPDX-License-Identifier: MIT
#include "core/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/terminal_colour.h"
#include "core/text.h"
#include "core/utf8.h"

namespace raymoval {
namespace {

using std::chrono::duration;

std::string duration_text(double seconds) {
  const long whole = std::max(0L, std::lround(seconds));
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

/// Letters that fit into a line of the terminal behind `stream`; 0 if it is none.
std::size_t line_width(std::FILE* stream) {
  winsize size{};
  if (::ioctl(::fileno(stream), TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return 0;
  return size.ws_col - 1U;
}

}  // namespace

ProgressStyle progress_style_of_stderr() {
  return ::isatty(STDERR_FILENO) != 0 ? ProgressStyle::kTerminal : ProgressStyle::kLog;
}

void Progress::set_context(const std::string& context) {
  const std::lock_guard lock(mutex_);
  context_ = context;
}

std::string Progress::context() {
  const std::lock_guard lock(mutex_);
  return context_;
}

void Progress::begin(const std::string& task, std::size_t total) {
  const std::lock_guard lock(mutex_);
  task_ = task;
  total_ = total;
  done_ = 0;
  ++tasks_;
  started_ = printed_ = Clock::now();
  if (style_ == ProgressStyle::kTerminal) print_terminal(started_);
}

void Progress::advance(std::size_t steps) {
  const std::lock_guard lock(mutex_);
  done_ += steps;
  if (style_ == ProgressStyle::kQuiet) return;
  const auto now = Clock::now();
  const double since = duration<double>(now - printed_).count();
  if (style_ == ProgressStyle::kTerminal && since >= 0.1) print_terminal(now);
  if (style_ == ProgressStyle::kLog && since >= 30.0) print_log(now);
}

void Progress::end() {
  const std::lock_guard lock(mutex_);
  if (style_ == ProgressStyle::kTerminal) std::fputs("\r\x1b[K", stream_);
  total_ = 0;
}

ProgressState Progress::state() {
  const std::lock_guard lock(mutex_);
  return {context_, task_, done_, total_, tasks_};
}

void Progress::say(const std::string& line) {
  if (style_ == ProgressStyle::kQuiet) return;
  const std::lock_guard lock(mutex_);
  if (style_ == ProgressStyle::kTerminal) std::fputs("\r\x1b[K", stream_);
  std::fprintf(stream_, "%s\n", terminal_text(line, stream_).c_str());
}

std::string Progress::status(Clock::time_point now) const {
  const double elapsed = duration<double>(now - started_).count();
  std::string text = task_ + ": " + std::to_string(done_) + " of " + std::to_string(total_);
  if (done_ > 0 && elapsed > 0.5) {
    const double left = elapsed / static_cast<double>(done_) * static_cast<double>(total_ - done_);
    text += ", about " + duration_text(left) + " left";
  }
  return text;
}

std::string Progress::with_context(const std::string& line) const {
  return context_.empty() ? line : context_ + ": " + line;
}

void Progress::print_terminal(Clock::time_point now) {
  printed_ = now;
  // A line that the terminal wraps cannot be cleared, so a long line is cut to the state only.
  std::string line = with_context(status(now));
  if (const std::size_t width = line_width(stream_); width > 0 && line.size() > width) {
    line = cut_text(status(now), width);
  }
  std::fprintf(stream_, "\r\x1b[K%s", printable_text(line).c_str());
  std::fflush(stream_);
}

void Progress::print_log(Clock::time_point now) {
  printed_ = now;
  std::fprintf(stream_, "%s\n", printable_text(with_context(status(now))).c_str());
}

}  // namespace raymoval
