// SPDX-License-Identifier: MIT
#include "datasets/reading/loading_ahead.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "core/error.h"

using namespace raymoval;

namespace {

/// Scans whose only point tells which they are. Notes who loaded what, and fails at scan 7.
class NotedScans : public ScanSource {
 public:
  explicit NotedScans(std::size_t size) : size_(size) {}
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] Scan load(std::size_t index) const override {
    {
      const std::lock_guard lock(mutex_);
      loads_.push_back(index);
      by_others_ += std::this_thread::get_id() == owner_ ? 0 : 1;
    }
    if (index == 7) throw DataError("scan 7 is torn");
    Scan scan;
    scan.index = index;
    scan.points = {{static_cast<float>(index), 0, 0}};
    return scan;
  }
  [[nodiscard]] Pose pose(std::size_t) const override { return Pose::Identity(); }
  [[nodiscard]] const SensorModel& sensor() const override { return sensor_; }

  [[nodiscard]] std::size_t loads() const {
    const std::lock_guard lock(mutex_);
    return loads_.size();
  }
  [[nodiscard]] std::size_t by_others() const {
    const std::lock_guard lock(mutex_);
    return by_others_;
  }

 private:
  std::size_t size_;
  std::thread::id owner_ = std::this_thread::get_id();
  mutable std::mutex mutex_;
  mutable std::vector<std::size_t> loads_;
  mutable std::size_t by_others_ = 0;
  SensorModel sensor_;
};

/// What other tests are busy with must not change what these tests see.
constexpr std::chrono::minutes kEver{10};
constexpr std::chrono::milliseconds kNever{0};

/// Waits until so many scans were loaded. The loader gets a processor only if nobody else wants it,
/// so this may take long, but it ends.
void wait_for_loads(const NotedScans& scans, std::size_t count) {
  while (scans.loads() < count) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

float first_value(const Scan& scan) {
  return scan.points.at(0).x();
}

}  // namespace

TEST_CASE("Whatever the order, each scan is the one that was asked for") {
  const NotedScans scans(7);
  for (const std::chrono::milliseconds patience : {kNever, LoadingAhead::kPatience}) {
    const LoadingAhead ahead(scans, patience);
    for (const std::size_t index :
         {0, 1, 2, 3, 4, 5, 6, 6, 5, 4, 3, 0, 2, 4, 6, 1, 1, 3, 2, 1, 0}) {
      CHECK(first_value(ahead.load(index)) == static_cast<float>(index));
    }
    CHECK(ahead.size() == 7);
  }
}

TEST_CASE("Even steps are foreseen, and only two scans ahead") {
  const NotedScans scans(100);
  const LoadingAhead ahead(scans, kEver);
  (void)ahead.load(0);
  (void)ahead.load(1);
  CHECK(scans.loads() == 2);  // One step may be by chance.
  (void)ahead.load(2);
  wait_for_loads(scans, 5);  // 0, 1, 2 and, ahead of time, 3 and 4.
  CHECK(scans.by_others() == 2);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  CHECK(scans.loads() == 5);
  CHECK(first_value(ahead.load(3)) == 3.0F);
  CHECK(first_value(ahead.load(4)) == 4.0F);
  CHECK(ahead.used() == 2);
}

TEST_CASE("A pass that goes backward is foreseen too, and none beyond the ends") {
  const NotedScans scans(7);
  const LoadingAhead ahead(scans, kEver);
  for (const std::size_t index : {6, 5, 4}) (void)ahead.load(index);
  wait_for_loads(scans, 5);
  for (const std::size_t index : {3, 2, 1, 0}) CHECK(first_value(ahead.load(index)) == index);
  CHECK(ahead.used() >= 2);
  CHECK(scans.loads() == 7);
}

TEST_CASE("An error comes when its scan is asked for, and not before") {
  const NotedScans scans(20);
  const LoadingAhead ahead(scans, kEver);
  for (const std::size_t index : {3, 4, 5}) (void)ahead.load(index);
  wait_for_loads(scans, 5);
  CHECK(first_value(ahead.load(6)) == 6.0F);
  CHECK_THROWS_WITH(ahead.load(7), "scan 7 is torn");
  CHECK(first_value(ahead.load(8)) == 8.0F);
}

TEST_CASE("What other threads ask for is not foreseen") {
  const NotedScans scans(20);
  const LoadingAhead ahead(scans);
  for (const std::size_t index : {0, 1}) (void)ahead.load(index);
  std::thread([&] { CHECK(first_value(ahead.load(12)) == 12.0F); }).join();
  for (const std::size_t index : {2, 3}) (void)ahead.load(index);
  CHECK(scans.loads() == 5);
  CHECK(ahead.used() == 0);
}
