// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include "core/files/descriptor.h"

namespace raymoval {

/// Reads a pipe and keeps the last 4 KiB.
class OutputTail {
 public:
  explicit OutputTail(Descriptor pipe);

  /// The pipe to wait for; -1 when all writers have closed it.
  [[nodiscard]] int pipe() const { return pipe_.get(); }
  /// Reads the available bytes without waiting, but at most 4 MiB, so that a program that never
  /// stops printing does not delay the time limit.
  void drain();
  /// The last 4 KiB. If there was more, the text starts with a whole line where that is possible.
  [[nodiscard]] std::string text() const;

 private:
  Descriptor pipe_;
  std::string text_;
};

}  // namespace raymoval
