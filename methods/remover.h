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

/// Takes a method's answer: one mask per scan, each scan exactly once, in any order, from any
/// thread. A wrong size, an unknown scan or a second mask for a scan is a MethodError.
class RemovalSink {
 public:
  virtual ~RemovalSink() = default;
  /// @param scan position in the source
  /// @param mask as long as the scan has points; 1 = removed, 0 = kept
  virtual void accept(std::size_t scan, const Mask& mask) = 0;
};

/// Takes why a method removed or kept each point, where it can say: a code per point, and a
/// sentence for each code. It is shown to people who look at single points and changes no score.
class ReasonSink {
 public:
  virtual ~ReasonSink() = default;
  /// Says what the codes mean. To be called once, before `accept`.
  /// @param sentences of the codes 0, 1, ..., at most 127
  virtual void explain(const std::vector<std::string>& sentences) = 0;
  /// Takes the reasons for a scan's mask, for each scan at most once, from any thread.
  /// @param codes as long as the scan has points
  virtual void accept(std::size_t scan, const std::vector<std::uint8_t>& codes) = 0;
};

/// Takes what speaks for it that each point belongs to something that moves, in a measure of the
/// method's own. It changes no mask and no score. `Calibration` makes a confidence of it.
class EvidenceSink {
 public:
  virtual ~EvidenceSink() = default;
  /// For each scan once, in any order, from any thread.
  /// @param evidence from 0 to 1, the more the likelier; as long as the scan has points
  virtual void accept(std::size_t scan, std::span<const float> evidence) = 0;
};

/// What a run gives a method besides its data. Everything optional may be null.
struct RunContext {
  int threads = 1;  ///< The method uses at most so many; the answer never depends on it.
  Progress* progress = nullptr;
  StageTimes* times = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  ReasonSink* reasons = nullptr;  ///< For a method that can give reasons; most cannot and need not.
  EvidenceSink* evidence = nullptr;  ///< For a method whose entry has a `Calibration`.

  /// @throws Cancelled if the run was asked to stop. Call it once a scan.
  void check_cancelled() const {
    if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) throw Cancelled();
  }
  void begin_pass(const char* what, std::size_t scans) const {
    if (progress != nullptr) progress->begin(what, scans);
  }
  void advance() const {
    if (progress != nullptr) progress->advance();
  }
};

/// A way to find the points of moving objects in a sequence of posed scans.
///
/// The same input gives the same answer whatever the number of threads. An online method answers
/// for scan t from scans 0 .. t, or until a delay later; an offline one sees all (its entry tells).
class Remover {
 public:
  virtual ~Remover() = default;
  /// Flags the points to remove, scan by scan, into `sink`.
  /// @throws MethodError or DataError; Cancelled if `context` asks to stop.
  virtual void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) = 0;
};

}  // namespace raymoval
