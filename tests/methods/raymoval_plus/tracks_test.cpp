// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/journeys.h"

#include <algorithm>
#include <catch2/catch.hpp>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

using Scans = std::vector<std::vector<ObjectSummary>>;
const std::vector<int> kNobody, kFirst{0};

/// A walker of half a metre after `steps` of 0.2 m along x, of 20 points, hit in some scans.
ObjectSummary walker(int steps, bool is_dynamic, double first_hit, double last_hit) {
  ObjectSummary object;
  object.center = {0.2 * steps, 0.0, 1.0};
  object.low = object.center - Eigen::Vector3d(0.25, 0.25, 0.7);
  object.high = object.center + Eigen::Vector3d(0.25, 0.25, 0.7);
  object.range = 10.0F;
  object.points = 20;
  // With a fifth of a pass a point, it is not dynamic, and it did not stand always.
  object.evidence.passes = is_dynamic ? 20.0F : 4.0F;
  object.first_hit = first_hit;
  object.last_hit = last_hit;
  object.hits = static_cast<float>(last_hit - first_hit + 1.0);
  return object;
}

/// A walker who moves on in each scan, and hits voxels for one scan before and after.
ObjectSummary walking(int scan, bool is_dynamic) {
  return walker(scan, is_dynamic, scan - 1, scan + 1);
}

/// An object as large as a van of 4 m.
ObjectSummary van(ObjectSummary object) {
  object.low = object.center - Eigen::Vector3d(2.0, 0.8, 0.7);
  object.high = object.center + Eigen::Vector3d(2.0, 0.8, 0.7);
  return object;
}

/// Moves an object aside.
ObjectSummary beside(ObjectSummary object, double y, int cluster) {
  for (Eigen::Vector3d* const at : {&object.center, &object.low, &object.high}) at->y() += y;
  object.cluster = cluster;
  return object;
}

/// One object in each scan.
template <class Object>
Scans scans_of(int count, Object&& object) {
  Scans scans;
  for (int i = 0; i < count; ++i) scans.push_back({object(i)});
  return scans;
}

/// The clusters that tracks mark. A scan comes every `period` seconds.
std::vector<std::vector<int>> marks(Scans scans, double period = 0.1) {
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (ObjectSummary& object : scans[i]) object.time_s = period * static_cast<double>(i);
  }
  return objects_on_tracks(scans, Parameters{}, RunContext{.threads = 2});
}

/// Whether somebody is marked in scan 25 who walks for ten scans, waits for thirty and walks on.
bool is_waiting_marked(double first_hit, double last_hit, float passes = 4.0F) {
  const auto marked = marks(scans_of(50, [&](int i) {
    if (i < 10 || i >= 40) return walking(i < 10 ? i : i - 29, true);
    ObjectSummary waiting = walker(10, false, first_hit, last_hit);
    waiting.evidence.passes = passes;
    return waiting;
  }));
  CHECK(marked[5].empty());  // It is dynamic.
  for (const std::size_t i : {10U, 39U}) CHECK(marked[i] == marked[25]);
  return marked[25] == kFirst;
}

}  // namespace

TEST_CASE("an object is followed past its last evidence and before its first, a standing one not") {
  for (const bool backward : {false, true}) {
    const auto is_known = [&](int i) { return backward ? i > 2 : i < 7; };
    Scans scans;
    for (int i = 0; i < 10; ++i) {
      scans.push_back({walking(i, is_known(i)), beside(walker(0, false, 0, 9), 5.0, 1)});
    }
    const auto marked = marks(scans);
    for (int i = 0; i < 10; ++i) {
      CHECK(marked[static_cast<std::size_t>(i)] == (is_known(i) ? kNobody : kFirst));
    }
    // It was hit for far longer than half a metre at 0.2 m a scan explains: another object.
    for (auto& objects : scans) objects[0].hits = 60.0F, objects[0].last_hit = 60.0;
    for (const auto& clusters : marks(scans)) CHECK(clusters.empty());
  }
}

TEST_CASE("what moves, stops and leaves is marked while it stands") {
  // It is in its place, within its width of 0.71 m, from scan 7 to 42. Voxels may be hit 3 scans
  // and a quarter of these 36 before and after.
  CHECK(is_waiting_marked(10, 39));
  CHECK(is_waiting_marked(-5, 54));
  CHECK_FALSE(is_waiting_marked(-6, 39));
  CHECK_FALSE(is_waiting_marked(10, 55));
}

TEST_CASE("what stood always is never marked") {
  // Ten scans hit it, and fewer than a fifth of a pass a point is outside.
  CHECK_FALSE(is_waiting_marked(10, 39, 3.9F));
  CHECK_FALSE(is_waiting_marked(12, 21, 3.9F));
  CHECK(is_waiting_marked(12, 20, 3.9F));  // Nine scans.
}

TEST_CASE("two that cross are told apart, and what they pass stays") {
  // They meet at x = 1.8 m, 0.5 m beside each other. A pole stands between their ways.
  const auto is_known = [](int i) { return i < 7 || i > 12; };
  Scans scans;
  for (int i = 0; i < 20; ++i) {
    scans.push_back({walking(i, is_known(i)),
                     beside(walker(18 - i, is_known(i), i - 1, i + 1), 0.5, 1),
                     beside(walker(9, false, 0, 19), 0.25, 2)});
    scans.back()[2].evidence.passes = 0.0F;
  }
  const auto marked = marks(scans);
  for (int i = 0; i < 20; ++i) {
    CHECK(marked[static_cast<std::size_t>(i)] == (is_known(i) ? kNobody : std::vector{0, 1}));
  }
}

TEST_CASE("a track may miss two scans, or ten while its object stands") {
  for (const std::size_t missed : {2U, 3U}) {
    Scans scans = scans_of(9, [](int i) { return walking(i, i < 6); });
    std::fill_n(scans.begin() + 6, missed, std::vector<ObjectSummary>{});
    scans.resize(7 + missed, {walking(9, false)});
    CHECK(marks(scans).back() == (missed == 2 ? kFirst : kNobody));
  }
  for (const int hidden : {10, 11}) {  // Stands for 20 scans, hidden in some of them, and walks.
    Scans scans = scans_of(
        27, [](int i) { return i < 20 ? walker(0, false, 0, 19) : walker(i - 19, true, i, i); });
    for (auto scan = scans.begin() + 16 - hidden; scan != scans.begin() + 16; ++scan) scan->clear();
    const auto marked = marks(scans);
    // Of a track that ends in scan 16, the voxels are hit too long before.
    for (const std::size_t i : {2U, 18U}) CHECK(marked[i] == (hidden == 10 ? kFirst : kNobody));
  }
}

TEST_CASE("a track needs three dynamic objects, a quarter of those that go on or of all") {
  for (const int dynamic : {2, 3}) {
    const Scans scans = scans_of(8, [&](int i) { return walking(i, i < dynamic); });
    CHECK(marks(scans)[7] == (dynamic == 3 ? kFirst : kNobody));
  }
  for (const int count : {12, 13}) {
    const Scans walks = scans_of(count, [](int i) { return walking(i, i < 3); });
    CHECK(marks(walks)[5] == (count == 12 ? kFirst : kNobody));
    // What stands may be hit 3 scans and a quarter of its scans before and after.
    for (const double first : {-6.0, -7.0}) {
      const Scans came = scans_of(count, [&](int i) { return walker(0, i < 3, first, 11); });
      CHECK(marks(came)[8] == (count == 12 && first == -6.0 ? kFirst : kNobody));
    }
  }
}

TEST_CASE("what waits is in its place however much of it is in sight") {
  // At first 2.8 m of a van are visible, then less and less behind its front, until that is 0.4 m
  // deep; then it drives off. Its centre shifts by 1.2 m meanwhile.
  const auto marked = marks(scans_of(50, [](int i) {
    const double front = 0.3 * std::max(i - 39, 0), depth = std::max(2.8 - 0.1 * i, 0.4);
    ObjectSummary seen = walker(0, i >= 40, 0, 39);
    seen.low = {front - depth, -0.9, 0.3};
    seen.high = {front, 0.9, 1.7};
    seen.center.x() = front - depth / 2.0;
    return seen;
  }));
  for (std::size_t i = 0; i < 40; ++i) CHECK(marked[i] == kFirst);
}

TEST_CASE("a parked car stays whose track something much smaller takes over") {
  // A walker of 0.71 m comes in ten scans; the object that stands for the next 40 scans is 1.56 or
  // 1.92 m wide. 1.5 times 0.71 m and 0.6 m are 1.66 m.
  for (const auto& [x, y, stays] : {std::tuple{0.6, 0.5, false}, std::tuple{0.75, 0.6, true}}) {
    const auto marked = marks(scans_of(50, [x = x, y = y](int i) {
      ObjectSummary object = i < 10 ? walking(i, true) : walker(10, false, 10, 49);
      if (i >= 10) object.low.head<2>() = object.center.head<2>() - Eigen::Vector2d(x, y);
      if (i >= 10) object.high.head<2>() = object.center.head<2>() + Eigen::Vector2d(x, y);
      return object;
    }));
    for (std::size_t i = 10; i < 50; ++i) CHECK(marked[i] == (stays ? kNobody : kFirst));
  }
}

TEST_CASE("an object that changed its size is another one") {
  for (const double taller : {1.4, 1.5}) {  // 0.6 m and 0.3 times 2.8 m or 2.9 m.
    const auto marked = marks(scans_of(10, [&](int i) {
      ObjectSummary object = walking(i, i < 7);
      if (i >= 7) object.high.z() += taller;
      return object;
    }));
    CHECK(marked[7] == (taller < 1.45 ? kFirst : kNobody));
  }
}

TEST_CASE("a fast object is followed from its first step on, up to 40 m/s") {
  // A van of 4 m drives 3.9 or 4.1 m a scan of 0.1 s.
  for (const double step : {3.9, 4.1}) {
    Scans scans = scans_of(8, [&](int i) {
      ObjectSummary object = walker(0, i < 5, i, i);
      object.center.x() = step * i;
      return van(object);
    });
    CHECK(marks(scans).back() == (step < 4.0 ? kFirst : kNobody));
    CHECK(marks(scans, 0.2).back() == kFirst);
    // A place that many scans hit was occupied before, so it is no fast object.
    for (auto& objects : scans) objects[0].hits = 6.0F;
    CHECK(marks(scans).back().empty());
  }
}

TEST_CASE("what brakes between scans half a second apart is followed") {
  // A van drives 2 m a scan, and stands from the fifth scan on. It is expected 2 m ahead then, less
  // than 0.6 m + 4.5 x 0.5^2 m + 0.35 x 2 m, but more than 0.6 m + 4.5 x 0.1^2 m + 0.35 x 2 m.
  for (const double period : {0.1, 0.5}) {
    const auto marked =
        marks(scans_of(8,
                       [](int i) {
                         return van(i < 5 ? walker(10 * i, true, i, i) : walker(40, false, 4, 7));
                       }),
              period);
    CHECK(marked[7] == (period == 0.5 ? kFirst : kNobody));
  }
}

TEST_CASE("what passes goes if scans hit its place no longer than length and speed explain") {
  // A walker passes a place that some scan hits much later. From scan 10 on his points are not
  // dynamic.
  for (const float hits : {2.0F, 60.0F}) {
    Scans scans = scans_of(55, [&](int i) { return walking(std::min(i, 14), i < 10); });
    for (std::size_t i = 15; i < scans.size(); ++i) scans[i].clear();
    for (std::size_t i = 10; i < 15; ++i) scans[i][0].last_hit = 45.0, scans[i][0].hits = hits;
    CHECK(marks(scans)[11] == (hits < 60.0F ? kFirst : kNobody));
  }
}

}  // namespace raymoval::raymoval_plus_test
