// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// An option that says how a sequence is read, on the command line and in Python.
struct ReadingOption {
  std::string name;      ///< "pose-format"; Python has _ for -.
  std::string type;      ///< The word for its value in --help; empty for a flag.
  std::string sentence;  ///< What --help says of it.
  /// Takes in the text of its value. @param option stands in messages. @throws UsageError
  void (*set)(SequenceOptions& options, const std::string& option, const std::string& text);
};

/// All of them, in the order of --help.
const std::vector<ReadingOption>& reading_options();

}  // namespace raymoval
