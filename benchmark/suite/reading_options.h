// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/sequence.h"

namespace raymoval {

/// An option for reading a sequence, on the command line and in Python.
struct ReadingOption {
  std::string name;      ///< "pose-format"; Python has _ for -.
  std::string type;      ///< The word for its value in --help; empty for a flag.
  std::string sentence;  ///< The description in --help.
  /// Sets the option from the text of its value. @param option for messages. @throws UsageError
  void (*set)(SequenceOptions& options, const std::string& option, const std::string& text);
};

/// All of them, in the order of --help.
const std::vector<ReadingOption>& reading_options();

}  // namespace raymoval
