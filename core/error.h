// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <stdexcept>
#include <string>

namespace raymoval {

/// Exit codes of the program.
enum class ExitCode {
  kDone = 0,      ///< Done.
  kWorse = 1,     ///< A comparison found a regression, or a cell failed.
  kCannotDo = 2,  ///< Cannot be done as asked: usage, data or configuration.
  kInternal = 3,  ///< A fault of this program.
};

/// Root of every error raised by raymoval. The message names the fault, the place (file, byte or
/// line, scan), the expected input, and a remedy.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message, ExitCode code = ExitCode::kCannotDo)
      : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode exit_code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// The command line or the arguments of a call are wrong.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(message) {}
};

/// A file or a data set is missing, damaged, or contradicts itself.
class DataError : public Error {
 public:
  explicit DataError(const std::string& message) : Error(message) {}
};

/// A parameter, suite or rule file has an unknown key or an illegal value.
class ConfigurationError : public Error {
 public:
  explicit ConfigurationError(const std::string& message) : Error(message) {}
};

/// A method broke its contract (wrong mask size, missing scan) or could not finish.
class MethodError : public Error {
 public:
  explicit MethodError(const std::string& message) : Error(message, ExitCode::kWorse) {}
};

/// The run was cancelled.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled before the end", ExitCode::kWorse) {}
};

/// @param cancel becomes true when the work shall end; null: it never does @throws Cancelled
inline void throw_if_cancelled(const std::atomic<bool>* cancel) {
  if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) throw Cancelled();
}

/// A broken invariant inside raymoval: a fault of the program and never of its user.
class InternalError : public Error {
 public:
  explicit InternalError(const std::string& message) : Error(message, ExitCode::kInternal) {}
};

}  // namespace raymoval
