// SPDX-License-Identifier: MIT
#include "benchmark/process/split_sensors.h"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/sampling.h"
#include "core/scan/local_frame.h"
#include "datasets/clouds/file_source.h"
#include "datasets/clouds/returns.h"
#include "datasets/ego/sensor_places.h"

namespace raymoval {
namespace {

/// Scan k + n i is what sensor k of n saw in merged scan i.
class SensorScans : public ScanSource {
 public:
  SensorScans(const ScanSource& merged, const RecordSource& records, const SensorPlaces& places)
      : merged_(merged), records_(records), places_(places), sensor_(std::nullopt) {}

  [[nodiscard]] std::size_t sensors() const { return places_.by_number.size(); }
  [[nodiscard]] const ScanSource& merged() const { return merged_; }
  [[nodiscard]] std::size_t size() const override { return merged_.size() * sensors(); }

  [[nodiscard]] Scan load(std::size_t index) const override {
    {
      const std::lock_guard lock(mutex_);
      if (auto waiting = waiting_.extract(index)) return std::move(waiting.mapped());
    }
    const std::size_t first = index - index % sensors();
    std::vector<Scan> pieces = split(merged_.load(index / sensors()));
    Scan asked = std::move(pieces[index - first]);
    const std::lock_guard lock(mutex_);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      if (first + k != index) waiting_.insert_or_assign(first + k, std::move(pieces[k]));
    }
    while (waiting_.size() > kMostWaiting) waiting_.erase(waiting_.begin());
    return asked;
  }

  [[nodiscard]] Pose pose(std::size_t index) const override {
    return merged_.pose(index / sensors()) * Eigen::Translation3d(place(index % sensors()));
  }

  [[nodiscard]] const SensorModel& sensor() const override {
    const SensorModel& model = merged_.sensor();
    if (model.name != "estimated") return model;
    return sensor_.get(size(), [this](std::size_t index) { return load(index); });
  }

  /// Which points of a merged scan each sensor saw. @throws DataError for an unknown sensor
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> positions(const Scan& whole) const {
    std::vector<std::vector<std::uint32_t>> of_sensor(sensors());
    const std::vector<std::size_t> seen_by = sensor_positions(records_, whole, places_);
    for (std::uint32_t i = 0; i < seen_by.size(); ++i) {
      const Eigen::Vector3d beam = whole.points[i].cast<double>() - place(seen_by[i]);
      if (beam.norm() >= kAtSensor) of_sensor[seen_by[i]].push_back(i);
    }
    return of_sensor;
  }

 private:
  /// Scans that are kept for the threads that will ask for them next.
  static constexpr std::size_t kMostWaiting = 64;

  [[nodiscard]] const Eigen::Vector3d& place(std::size_t sensor) const {
    return std::next(places_.by_number.begin(), static_cast<std::ptrdiff_t>(sensor))->second;
  }

  [[nodiscard]] std::vector<Scan> split(const Scan& whole) const {
    auto of_sensor = positions(whole);
    std::vector<Scan> pieces(sensors(), whole);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      keep_points(pieces[k], std::move(of_sensor[k]));
      pieces[k].index = whole.index * sensors() + k;
      pieces[k].T_world_sensor = whole.T_world_sensor * Eigen::Translation3d(place(k));
      for (Eigen::Vector3f& point : pieces[k].points) {
        point = (point.cast<double>() - place(k)).cast<float>();
      }
    }
    return pieces;
  }

  const ScanSource& merged_;
  const RecordSource& records_;
  const SensorPlaces& places_;
  SensorChoice sensor_;
  mutable std::mutex mutex_;
  mutable std::map<std::size_t, Scan> waiting_;  ///< Loaded with another sensor's, by number.
};

/// Puts the answers for the scans of the sensors together. Points of no sensor get 0.
template <class Value>
class JoinedAnswers {
 public:
  using PassOn = std::function<void(std::size_t, const std::vector<Value>&)>;
  JoinedAnswers(const SensorScans& scans, PassOn pass_on)
      : scans_(scans), pass_on_(std::move(pass_on)), answered_(scans.size(), 0) {}

  /// @throws MethodError for an unknown scan, a second answer or a wrong size
  void accept(std::size_t scan, std::span<const Value> values) {
    if (scan >= scans_.size()) throw_wrong(scan, "there is no such scan");
    const std::size_t whole = scan / scans_.sensors();
    std::vector<std::vector<Value>> parts;
    {
      const std::lock_guard lock(mutex_);
      if (std::exchange(answered_[scan], 1) != 0) throw_wrong(scan, "answered a second time");
      auto& waiting = waiting_[whole];
      waiting.parts.resize(scans_.sensors());
      waiting.parts[scan % scans_.sensors()].assign(values.begin(), values.end());
      if (++waiting.count < scans_.sensors()) return;
      parts = std::move(waiting.parts);
      waiting_.erase(whole);
    }
    pass_on_(whole, joined(whole, parts));
  }

 private:
  struct Waiting {
    std::vector<std::vector<Value>> parts;
    std::size_t count = 0;
  };

  std::vector<Value> joined(std::size_t whole, const std::vector<std::vector<Value>>& parts) const {
    const Scan scan = scans_.merged().load(whole);
    const auto positions = scans_.positions(scan);
    std::vector<Value> values(scan.size(), Value{});
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (parts[k].size() != positions[k].size()) {
        throw_wrong(whole * parts.size() + k, "one value for each point was expected");
      }
      for (std::size_t i = 0; i < parts[k].size(); ++i) values[positions[k][i]] = parts[k][i];
    }
    return values;
  }

  [[noreturn]] static void throw_wrong(std::size_t scan, const char* what) {
    throw MethodError(fmt::format("scan {} of the sensors: {}.", scan, what));
  }

  const SensorScans& scans_;
  PassOn pass_on_;
  std::mutex mutex_;
  std::vector<std::uint8_t> answered_;
  std::map<std::size_t, Waiting> waiting_;
};

class JoinedMasks : public RemovalSink {
 public:
  JoinedMasks(const SensorScans& scans, RemovalSink& sink)
      : joined_(scans, [&sink](std::size_t scan, const Mask& mask) { sink.accept(scan, mask); }) {}
  void accept(std::size_t scan, const Mask& mask) override { joined_.accept(scan, mask); }

 private:
  JoinedAnswers<std::uint8_t> joined_;
};

class JoinedReasons : public ReasonSink {
 public:
  JoinedReasons(const SensorScans& scans, ReasonSink& sink)
      : sink_(sink),
        joined_(scans, [&sink](std::size_t scan, const auto& codes) { sink.accept(scan, codes); }) {
  }
  void explain(const std::vector<std::string>& sentences) override { sink_.explain(sentences); }
  void accept(std::size_t scan, const std::vector<std::uint8_t>& codes) override {
    joined_.accept(scan, codes);
  }

 private:
  ReasonSink& sink_;
  JoinedAnswers<std::uint8_t> joined_;
};

class JoinedEvidence : public EvidenceSink {
 public:
  JoinedEvidence(const SensorScans& scans, EvidenceSink& sink)
      : joined_(scans,
                [&sink](std::size_t scan, const auto& values) { sink.accept(scan, values); }) {}
  void accept(std::size_t scan, std::span<const float> evidence) override {
    joined_.accept(scan, evidence);
  }

 private:
  JoinedAnswers<float> joined_;
};

class SplitSensors : public Remover {
 public:
  SplitSensors(std::unique_ptr<Remover> method, const Sequence& sequence)
      : method_(std::move(method)), sequence_(sequence) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    const SensorScans pieces(scans, *sequence_.records, *sequence_.sensor_origin);
    JoinedMasks masks(pieces, sink);
    RunContext inner = context;
    std::optional<JoinedReasons> reasons;
    if (context.reasons != nullptr) inner.reasons = &reasons.emplace(pieces, *context.reasons);
    std::optional<JoinedEvidence> evidence;
    if (context.evidence != nullptr) inner.evidence = &evidence.emplace(pieces, *context.evidence);
    const LocalFrameSource upright(pieces, Pose::Identity(), pieces.sensor().spin_axis);
    method_->run(upright, masks, inner);
  }

 private:
  std::unique_ptr<Remover> method_;
  const Sequence& sequence_;
};

/// Whether a cloud has points of several sensors. Scans of several topics are apart already.
bool is_merged(const Sequence& sequence) {
  return sequence.sensor_origin && !sequence.sensor_origin->field.empty() &&
         sequence.topics.empty();
}

}  // namespace

Eigen::Vector3d spin_axis_of(const Sequence& sequence) {
  if (is_merged(sequence)) return Eigen::Vector3d::UnitZ();
  const ScanSource& source = *sequence.scans;
  if (source.sensor().is_estimated()) return source.sensor().spin_axis;
  std::vector<Scan> scans;
  for (const std::size_t i : evenly_spread(source.size(), 5)) scans.push_back(source.load(i));
  return estimate_spin_axis(scans);
}

std::unique_ptr<Remover> with_split_sensors(std::unique_ptr<Remover> method,
                                            const Sequence& sequence) {
  if (!is_merged(sequence)) return method;
  return std::make_unique<SplitSensors>(std::move(method), sequence);
}

}  // namespace raymoval
