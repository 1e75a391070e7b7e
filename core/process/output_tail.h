// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include "core/files/descriptor.h"

namespace raymoval {

/// Takes what comes out of a pipe and keeps the last 4 KiB of it.
class OutputTail {
 public:
  explicit OutputTail(Descriptor pipe);

  /// The pipe to wait for; -1 once nobody can write to it any more.
  [[nodiscard]] int pipe() const { return pipe_.get(); }
  /// Takes what is there without waiting, but at most 4 MiB: a program that never stops printing
  /// must not hold up the clock.
  void drain();
  /// The last 4 KiB. If there was more, the text starts with a whole line where that is possible.
  [[nodiscard]] std::string text() const;

 private:
  Descriptor pipe_;
  std::string text_;
};

}  // namespace raymoval
