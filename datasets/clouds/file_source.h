// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/scan/scan_source.h"
#include "datasets/clouds/format/cloud_format.h"
#include "datasets/records/record_source.h"

namespace raymoval {

/// A scan on disk, without its points.
struct FrameEntry {
  std::filesystem::path path;
  std::filesystem::path label_path;  ///< Empty if there are no labels.
  std::string name;                  ///< "000123".
  double time_s = 0.0;
  Pose T_world_sensor = Pose::Identity();
};

/// A sensor model by name, or estimated from up to five evenly spaced scans at the first `get`.
class SensorChoice {
 public:
  using Load = std::function<Scan(std::size_t)>;
  /// @param name a known sensor; nothing or "estimated" for an estimate
  /// @throws ConfigurationError for an unknown name
  explicit SensorChoice(const std::optional<std::string>& name);
  /// Thread-safe. @throws DataError if a scan cannot be read
  const SensorModel& get(std::size_t scan_count, const Load& load) const;

 private:
  mutable std::once_flag once_;
  mutable std::optional<SensorModel> model_;
};

/// Counts the points that are left out of scans. A scan counts once, even if several threads read
/// it several times.
class LeftOutTally {
 public:
  explicit LeftOutTally(std::size_t scans) : scans_(scans) {}
  void set(std::size_t scan, std::uint64_t stored, std::uint64_t left_out) const {
    const std::lock_guard lock(mutex_);
    scans_[scan] = {stored, left_out};
    if (stored == left_out) empty_.insert(scan);
  }
  /// The counted scans without a point left, in order.
  [[nodiscard]] std::set<std::size_t> empty() const {
    const std::lock_guard lock(mutex_);
    return empty_;
  }
  /// The stored and the left out points of all counted scans.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> total() const {
    const std::lock_guard lock(mutex_);
    std::pair<std::uint64_t, std::uint64_t> sum{0, 0};
    for (const auto& [stored, left_out] : scans_) {
      sum.first += stored;
      sum.second += left_out;
    }
    return sum;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::pair<std::uint64_t, std::uint64_t>> scans_;
  mutable std::set<std::size_t> empty_;
};

/// Scans that count their missing returns.
class TalliedSource {
 public:
  virtual ~TalliedSource() = default;
  /// Missing returns of the scans that were read.
  [[nodiscard]] virtual const LeftOutTally& tally() const = 0;
};

/// Scans in one file each, in any of `cloud_formats`, and their records. Points that are no returns
/// are left out (see `read_returns`); `tally` counts them. `load` throws as `read_returns`.
class FileScanSource : public ScanSource, public RecordSource, public TalliedSource {
 public:
  struct Traits {
    PointFrame point_frame = PointFrame::kSensor;
    bool has_reflectance = true;  ///< False if the files' intensity is no reflectance.
    RecordReading reading = {};   ///< Facts that the files do not state.
  };
  FileScanSource(std::vector<FrameEntry> frames, Traits traits,
                 const std::optional<std::string>& sensor)
      : frames_(std::move(frames)),
        traits_(std::move(traits)),
        sensor_(sensor),
        tally_(frames_.size()) {}

  [[nodiscard]] std::size_t size() const override { return frames_.size(); }
  [[nodiscard]] Scan load(std::size_t index) const override;
  [[nodiscard]] Pose pose(std::size_t index) const override;
  [[nodiscard]] const SensorModel& sensor() const override;
  [[nodiscard]] PointRecords records(std::size_t index) const override;
  [[nodiscard]] RecordLayout layout(std::size_t index) const override;
  [[nodiscard]] PointFrame point_frame() const override { return traits_.point_frame; }
  [[nodiscard]] std::string place(std::size_t index) const override;
  [[nodiscard]] const std::vector<FrameEntry>& frames() const { return frames_; }
  [[nodiscard]] const LeftOutTally& tally() const override { return tally_; }

 private:
  std::vector<FrameEntry> frames_;
  Traits traits_;
  SensorChoice sensor_;
  LeftOutTally tally_;
};

/// Selects from `stored`, one word for each stored point of `scan`, the words of its points.
std::vector<std::uint32_t> of_kept_points(const Scan& scan, std::vector<std::uint32_t> stored);

/// The label of all points of a scan without a label file, if other scans have one.
inline constexpr std::uint16_t kNoLabelFile = 65535;

/// SemanticKITTI label files: one uint32 a stored point, in the order of the scan file.
class LabelFileSource : public LabelSource {
 public:
  explicit LabelFileSource(std::vector<FrameEntry> frames) : frames_(std::move(frames)) {}
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override;

 private:
  std::vector<FrameEntry> frames_;
};

/// Label words by value in the files' own intensity (1 or 252.0).
class IntensityLabelSource : public LabelSource {
 public:
  explicit IntensityLabelSource(std::vector<FrameEntry> frames) : frames_(std::move(frames)) {}
  /// @throws DataError if the intensity of a point of `scan` is no whole number from 0 to 2^24 - 1
  ///   (what float32 holds exactly)
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override;

 private:
  std::vector<FrameEntry> frames_;
};

}  // namespace raymoval
