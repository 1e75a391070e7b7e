// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "core/scan/scan_source.h"

namespace raymoval {

/// Hands on the scans of a source. While the owning thread works on a scan, another thread loads
/// those that it will ask for next, if it goes through the scans in even steps. At most
/// `kScansAhead` scans are held. What comes out is what the source gives, errors too, each when its
/// scan is asked for.
///
/// The other thread takes only processor time that nobody else wants (SCHED_IDLE), so that it does
/// not disturb who is timed. If nobody leaves any, the owner loads for itself as if there were no
/// such thread. So do threads other than the owner.
class LoadingAhead : public ScanSource {
 public:
  static constexpr std::size_t kScansAhead = 2;

  /// A scan is loaded in a few milliseconds. Where the loader needs longer, it gets no processor.
  static constexpr std::chrono::milliseconds kPatience{20};

  /// The calling thread becomes the owner.
  /// @param source must outlive this object
  /// @param patience for so long the owner waits for a scan that is being loaded; then it loads the
  /// scan itself
  explicit LoadingAhead(const ScanSource& source, std::chrono::milliseconds patience = kPatience)
      : source_(source), patience_(patience), owner_(std::this_thread::get_id()) {}
  ~LoadingAhead() override;
  LoadingAhead(const LoadingAhead&) = delete;
  LoadingAhead& operator=(const LoadingAhead&) = delete;

  [[nodiscard]] std::size_t size() const override { return source_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override { return source_.pose(index); }
  [[nodiscard]] const SensorModel& sensor() const override { return source_.sensor(); }
  /// Scans that were loaded before they were asked for, and then asked for.
  [[nodiscard]] std::size_t used() const;

 private:
  struct Loaded {
    Scan scan;
    std::exception_ptr error = nullptr;
  };
  using Lock = std::unique_lock<std::mutex>;

  /// Says which scans come next, if that can be told.
  void wish_after(std::size_t index) const;
  [[nodiscard]] std::optional<Loaded> take(std::size_t index, Lock& lock) const;
  void start_loader() const;
  void load_wishes() const;

  const ScanSource& source_;
  std::chrono::milliseconds patience_;
  std::thread::id owner_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable std::optional<std::size_t> last_;  ///< Asked for by the owner, and by nobody else since.
  mutable std::ptrdiff_t step_ = 0;
  mutable std::deque<std::size_t> wishes_;
  mutable std::optional<std::size_t> loading_;
  mutable std::map<std::size_t, Loaded> loaded_;
  mutable bool is_waited_for_ = false;  ///< The owner waits for what is being loaded.
  mutable std::size_t used_ = 0;
  mutable bool is_ending_ = false;
  mutable bool has_loader_ = false;
  mutable std::thread loader_;
};

}  // namespace raymoval
