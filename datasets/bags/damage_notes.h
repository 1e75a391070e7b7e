// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace raymoval {

/// Sentences on what of a recording could not be read. The first few are kept and the rest are
/// counted, so that a file with damage everywhere fills no memory. All calls are thread-safe.
class DamageNotes {
 public:
  /// How many sentences are kept.
  static constexpr std::size_t kMost = 8;

  /// @param sentence what is wrong, with the file and the byte. One that is there already is left
  ///   out.
  void add(std::string sentence);
  /// The sentences in the order in which they came, and one with the number of those left out.
  [[nodiscard]] std::vector<std::string> sentences() const;
  [[nodiscard]] bool empty() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> kept_;
  std::size_t more_ = 0;
};

}  // namespace raymoval
