// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/progress.h"
#include "core/scan/scan.h"
#include "core/scan/scan_source.h"
#include "core/stage_timer.h"

namespace raymoval {

/// Receives a method's result: one mask per scan, each scan exactly once, in any order, from any
/// thread. A wrong size, an unknown scan or a second mask for a scan is a MethodError.
class RemovalSink {
 public:
  virtual ~RemovalSink() = default;
  /// @param scan position in the source
  /// @param mask as long as the scan has points; 1 = removed, 0 = kept
  virtual void accept(std::size_t scan, const Mask& mask) = 0;
};

/// Receives the reasons for which a method removed or kept each point, if it has any: a code per
/// point, and a sentence for each code. They are shown for single points and have no effect on
/// scores.
class ReasonSink {
 public:
  virtual ~ReasonSink() = default;
  /// Sets the meaning of the codes. Must be called once, before `accept`.
  /// @param sentences of the codes 0, 1, ..., at most 127
  virtual void explain(const std::vector<std::string>& sentences) = 0;
  /// Receives the reasons for a scan's mask, for each scan at most once, from any thread.
  /// @param codes as long as the scan has points
  virtual void accept(std::size_t scan, const std::vector<std::uint8_t>& codes) = 0;
};

/// Receives the evidence that each point moves, in a measure that each method defines. It has no
/// effect on masks and scores. `Calibration` converts it to a confidence.
class EvidenceSink {
 public:
  virtual ~EvidenceSink() = default;
  /// For each scan once, in any order, from any thread.
  /// @param evidence from 0 to 1, rising with the likelihood of motion; one per point of the scan
  virtual void accept(std::size_t scan, std::span<const float> evidence) = 0;
};

/// The context of a method's run. Pointers may be null.
struct RunContext {
  int threads = 1;  ///< The most threads that the method may use; no effect on the result.
  Progress* progress = nullptr;
  StageTimes* times = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  ReasonSink* reasons = nullptr;     ///< For methods that give reasons; optional.
  EvidenceSink* evidence = nullptr;  ///< For a method whose entry has a `Calibration`.

  /// @throws Cancelled if the run was cancelled. Call it once per scan.
  void check_cancelled() const { throw_if_cancelled(cancel); }
  void begin_pass(const char* what, std::size_t scans) const {
    if (progress != nullptr) progress->begin(what, scans);
  }
  void advance() const {
    if (progress != nullptr) progress->advance();
  }
};

/// A way to find the points of moving objects in a sequence of posed scans.
///
/// The same input gives the same result for any number of threads. An online method computes the
/// mask of scan t from scans 0 .. t, or up to a delay later; an offline method uses all scans (see
/// its entry).
class Remover {
 public:
  virtual ~Remover() = default;
  /// Flags the points to remove, scan by scan, into `sink`.
  /// @throws MethodError or DataError; Cancelled if the run was cancelled.
  virtual void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) = 0;
};

}  // namespace raymoval
