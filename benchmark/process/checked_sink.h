// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <string>
#include <utility>

#include "benchmark/process/timed_source.h"
#include "core/scan/mask_store.h"
#include "methods/remover.h"

namespace raymoval {

/// @throws MethodError for an unknown scan, a wrong size, or a value that is neither 0 nor 1
void check_answer(const std::string& method, const TimedSource& scans, std::size_t scan,
                  const Mask& mask);
[[noreturn]] void throw_second_answer(const std::string& method, std::size_t scan);
[[noreturn]] void throw_missing_answer(const std::string& method, std::size_t scan,
                                       std::size_t scans);

/// Keeps a method's masks and checks that the method keeps to its contract.
class CheckedSink : public RemovalSink {
 public:
  /// @param method name for messages
  CheckedSink(std::string method, const TimedSource& scans)
      : method_(std::move(method)), scans_(scans), masks_(scans.size()) {}

  /// @throws MethodError for an unknown scan, a second mask, a wrong size, or a value that is
  /// neither 0 nor 1.
  void accept(std::size_t scan, const Mask& mask) override;

  /// The masks. @throws MethodError that names the first scan without a mask
  [[nodiscard]] const MaskStore& finish() const;

 private:
  std::string method_;
  const TimedSource& scans_;
  std::mutex mutex_;
  MaskStore masks_;
};

/// Hash of all masks. Two methods gave the same answer exactly if their hashes are equal.
std::string mask_digest(const MaskStore& masks);

}  // namespace raymoval
