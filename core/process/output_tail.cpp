// SPDX-License-Identifier: MIT
#include "core/process/output_tail.h"

#include <fcntl.h>

#include <cerrno>

namespace raymoval {
namespace {

constexpr std::size_t kTailBytes = 4096;

}  // namespace

OutputTail::OutputTail(Descriptor pipe) : pipe_(std::move(pipe)) {
  ::fcntl(pipe_.get(), F_SETFL, O_NONBLOCK);
}

void OutputTail::drain() {
  char buffer[65536];
  for (int reads = 0; pipe_.valid() && reads < 64; ++reads) {
    const ssize_t got = ::read(pipe_.get(), buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return;
    if (got == 0) pipe_.close();
    text_.append(buffer, static_cast<std::size_t>(got));
    if (text_.size() > 16 * kTailBytes) text_.erase(0, text_.size() - kTailBytes - 1);
  }
}

std::string OutputTail::text() const {
  if (text_.size() <= kTailBytes) return text_;
  // The byte before the tail shows whether the tail starts a line.
  const std::string tail = text_.substr(text_.size() - kTailBytes - 1);
  const std::size_t line = tail.find('\n');
  return tail.substr(line == std::string::npos || line + 1 == tail.size() ? 1 : line + 1);
}

}  // namespace raymoval
