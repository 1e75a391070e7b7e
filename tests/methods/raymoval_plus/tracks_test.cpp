// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/journeys.h"

#include <algorithm>
#include <catch2/catch.hpp>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

using Scans = std::vector<std::vector<ObjectSummary>>;
const std::vector<int> kNone, kFirst{0};

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

/// Makes an object as large as a van of 4 m.
void make_van(ObjectSummary& object) {
  object.low = object.center - Eigen::Vector3d(2.0, 0.8, 0.7);
  object.high = object.center + Eigen::Vector3d(2.0, 0.8, 0.7);
}

/// The clusters that tracks mark. A scan comes every `period` seconds.
Scans at_times(Scans scans, double period) {
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (ObjectSummary& object : scans[i]) object.time_s = period * static_cast<double>(i);
  }
  return scans;
}
std::vector<std::vector<int>> marks(const Scans& scans, double period = 0.1) {
  return objects_on_tracks(at_times(scans, period), Parameters{}, RunContext{.threads = 2});
}

/// Somebody who walks for ten scans, waits for thirty and walks on. Hardly a beam passed his place.
Scans waiting_walker(double first_hit, double last_hit, float passes = 4.0F) {
  Scans scans;
  for (int i = 0; i < 50; ++i) {
    const bool waits = i >= 10 && i < 40;
    scans.push_back({waits ? walker(10, false, first_hit, last_hit)
                           : walking(i < 10 ? i : i - 29, true)});
    if (waits) scans.back()[0].evidence.passes = passes;
  }
  return scans;
}

}  // namespace

TEST_CASE("an object is dynamic with enough passes a point, or fewer and a contradiction") {
  ObjectSummary object = walking(0, true);
  CHECK(is_dynamic(object, Parameters{}));
  object.points = 21;
  CHECK_FALSE(is_dynamic(object, Parameters{}));
  object.evidence.contradiction = 4.3F;  // More than a fifth of 21.
  CHECK(is_dynamic(object, Parameters{}));
  object.evidence.passes = 4.1F;
  CHECK_FALSE(is_dynamic(object, Parameters{}));
}

TEST_CASE("an object is followed past its last evidence and before its first, a standing one not") {
  for (const bool backward : {false, true}) {
    Scans scans;
    for (int i = 0; i < 10; ++i) {
      const int time = backward ? 9 - i : i;
      scans.push_back({walking(i, time < 7), walker(0, false, 0, 9)});
      scans.back()[1].center.y() += 5.0;
      scans.back()[1].cluster = 1;
    }
    const auto marked = marks(scans);
    for (int i = 0; i < 10; ++i) {
      const bool is_known = (backward ? 9 - i : i) < 7;
      CHECK(marked[static_cast<std::size_t>(i)] == (is_known ? kNone : kFirst));
    }
    if (backward) continue;
    // Scan by scan: the walker of scan 7 is marked by its own past.
    ObjectTracker tracker{Parameters{}};
    for (std::size_t i = 0; i < 8; ++i) tracker.follow(i, at_times(scans, 0.1)[i]);
    CHECK(marked_in(7, tracker.finish(), Parameters{}) == kFirst);
    // It was hit for far longer than half a metre at 0.2 m a scan explains: another object.
    for (auto& objects : scans) objects[0].hits = 60.0F, objects[0].last_hit = 60.0;
    CHECK(marks(scans)[9].empty());
  }
}

TEST_CASE("what moves, stops and leaves is marked while it stands") {
  // It is in its place, within its width of 0.71 m, from scan 7 to 42. Voxels may be hit 3 scans
  // and a quarter of these 36 before and after.
  struct Case {
    double first, last;
    bool is_marked;
  };
  for (const auto& [first, last, is_marked] :
       {Case{10, 39, true}, Case{-5, 54, true}, Case{-6, 39, false}, Case{10, 55, false}}) {
    const auto marked = marks(waiting_walker(first, last));
    CAPTURE(first, last);
    CHECK(marked[5].empty());  // It is dynamic.
    for (const std::size_t i : {10U, 25U, 39U}) CHECK(marked[i] == (is_marked ? kFirst : kNone));
  }
}

TEST_CASE("what stood always is never marked") {
  // Ten scans hit it, and fewer than a fifth of a pass a point is outside.
  CHECK(marks(waiting_walker(10, 39, 4.0F))[25] == kFirst);
  CHECK(marks(waiting_walker(10, 39, 3.9F))[25].empty());
  CHECK(marks(waiting_walker(12, 21, 3.9F))[25].empty());
  CHECK(marks(waiting_walker(12, 20, 3.9F))[25] == kFirst);  // Nine scans.
}

TEST_CASE("two that cross are told apart, and what they pass stays") {
  // They meet at x = 1.8 m, 0.5 m beside each other. A pole stands between their ways.
  Scans scans;
  for (int i = 0; i < 20; ++i) {
    const bool is_known = i < 7 || i > 12;
    std::vector<ObjectSummary> objects{walking(i, is_known), walking(18 - i, is_known),
                                       walker(9, false, 0, 19)};
    objects[1].first_hit = i - 1;
    objects[1].last_hit = i + 1;
    objects[2].evidence.passes = 0.0F;
    for (int k = 0; k < 3; ++k) {
      objects[static_cast<std::size_t>(k)].cluster = k;
      for (const auto at : {&ObjectSummary::center, &ObjectSummary::low, &ObjectSummary::high}) {
        (objects[static_cast<std::size_t>(k)].*at).y() += k == 1 ? 0.5 : k == 2 ? 0.25 : 0.0;
      }
    }
    scans.push_back(objects);
  }
  const auto marked = marks(scans);
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(marked[i] == (i < 7 || i > 12 ? kNone : std::vector<int>{0, 1}));
  }
}

TEST_CASE("a track may miss two scans, or ten while its object stands") {
  for (const int missed : {2, 3}) {
    Scans scans;
    for (int i = 0; i < 6; ++i) scans.push_back({walking(i, true)});
    scans.resize(static_cast<std::size_t>(6 + missed));
    scans.push_back({walking(6 + missed, false)});
    CHECK(marks(scans).back() == (missed == 2 ? kFirst : kNone));
  }
  for (const int hidden : {10, 11}) {  // Stands for 20 scans, hidden in some of them, and walks.
    Scans scans(27);
    for (int i = 0; i < 27; ++i) {
      if (i < 16 && i >= 16 - hidden) continue;
      scans[static_cast<std::size_t>(i)] = {i < 20 ? walker(0, false, 0, 19)
                                                   : walker(i - 19, true, i, i)};
    }
    const auto marked = marks(scans);
    // Of a track that ends in scan 16, the voxels are hit too long before.
    for (const std::size_t i : {2U, 18U}) CHECK(marked[i] == (hidden == 10 ? kFirst : kNone));
  }
}

TEST_CASE("a track needs three dynamic objects, a quarter of those that do not stand") {
  for (const int dynamic : {2, 3}) {
    Scans scans;
    for (int i = 0; i < 8; ++i) scans.push_back({walking(i, i < dynamic)});
    CHECK(marks(scans)[7] == (dynamic == 3 ? kFirst : kNone));
  }
  for (const int others : {9, 10}) {
    Scans scans;
    for (int i = 0; i < 3 + others; ++i) scans.push_back({walking(i, i < 3)});
    CHECK(marks(scans)[5] == (others == 9 ? kFirst : kNone));
  }
}

TEST_CASE("what came or leaves, and stands else, is marked if a quarter of it is dynamic") {
  // Voxels may be hit 3 scans and a quarter of its scans before and after.
  struct Case {
    int scans;
    double first;
    bool is_marked;
  };
  for (const auto& [count, first, is_marked] :
       {Case{12, 0, true}, Case{12, -6, true}, Case{12, -7, false}, Case{13, 0, false}}) {
    Scans scans;
    for (int i = 0; i < count; ++i) scans.push_back({walker(0, i < 3, first, count - 1)});
    CAPTURE(count, first);
    CHECK(marks(scans)[8] == (is_marked ? kFirst : kNone));
  }
}

TEST_CASE("what waits is in its place however much of it is in sight") {
  // A van waits for 40 scans. At first 2.8 m of it are visible, then less and less behind its
  // front, until that is 0.4 m deep; then it drives off. Its centre shifts by 1.2 m meanwhile.
  Scans scans;
  for (int i = 0; i < 50; ++i) {
    const double front = 0.3 * std::max(i - 39, 0), depth = std::max(2.8 - 0.1 * i, 0.4);
    ObjectSummary van = walker(0, i >= 40, 0, 39);
    van.low.x() = front - depth;
    van.high.x() = front;
    van.center.x() = front - depth / 2.0;
    van.low.y() = -0.9;
    van.high.y() = 0.9;
    scans.push_back({van});
  }
  const auto marked = marks(scans);
  for (std::size_t i = 0; i < 40; ++i) CHECK(marked[i] == kFirst);
}

TEST_CASE("a parked car stays whose track something much smaller takes over") {
  // A walker of 0.71 m comes in ten scans; the object that stands for the next 40 scans is 1.56 or
  // 1.92 m wide. 1.5 times 0.71 m and 0.6 m are 1.66 m.
  for (const bool is_larger : {false, true}) {
    Scans scans;
    for (int i = 0; i < 50; ++i) {
      scans.push_back({i < 10 ? walking(i, true) : walker(10, false, 10, 49)});
      if (i < 10) continue;
      ObjectSummary& standing = scans.back()[0];
      const Eigen::Vector3d half =
          is_larger ? Eigen::Vector3d(0.75, 0.6, 0.7) : Eigen::Vector3d(0.6, 0.5, 0.7);
      standing.low = standing.center - half;
      standing.high = standing.center + half;
    }
    const auto marked = marks(scans);
    for (std::size_t i = 10; i < 50; ++i) CHECK(marked[i] == (is_larger ? kNone : kFirst));
  }
}

TEST_CASE("an object that changed its size is another one") {
  Scans scans;
  for (int i = 0; i < 10; ++i) {
    scans.push_back({walking(i, i < 7)});
    if (i >= 7) scans.back()[0].high.z() += 2.0;  // 2 m more than 0.6 m + 0.3 x 3.4 m.
  }
  CHECK(marks(scans)[7].empty());
}

TEST_CASE("a fast object is followed from its first step on, up to 40 m/s") {
  // A van of 4 m drives 3.9 or 4.1 m a scan of 0.1 s.
  for (const double step : {3.9, 4.1}) {
    Scans scans;
    for (int i = 0; i < 8; ++i) {
      scans.push_back({walker(0, i < 5, i, i)});
      scans.back()[0].center.x() = 10.0 + step * i;
      make_van(scans.back()[0]);
    }
    CHECK(marks(scans).back() == (step < 4.0 ? kFirst : kNone));
    CHECK(marks(scans, 0.2).back() == kFirst);
    // A place that many scans hit was occupied before, so it is no fast object.
    for (auto& objects : scans) objects[0].hits = 6.0F;
    CHECK(marks(scans).back().empty());
  }
}

TEST_CASE("what brakes between scans half a second apart is followed") {
  // A van drives 2 m per scan along x, and is stationary from the fifth scan on at a place that
  // hardly a beam passed. It is expected 2 m ahead then, which is less than
  // 0.6 m + 4.5 x 0.5^2 m + 0.35 x 2 m, but more than 0.6 m + 4.5 x 0.1^2 m + 0.35 x 2 m.
  for (const double period : {0.1, 0.5}) {
    Scans scans;
    for (int i = 0; i < 8; ++i) {
      scans.push_back({walker(10 * std::min(i, 4), i < 5, i < 5 ? i : 4, i < 5 ? i : 7)});
      make_van(scans.back()[0]);
    }
    CHECK(marks(scans, period)[7] == (period == 0.5 ? kFirst : kNone));
  }
}

TEST_CASE("what passes is hit for as long as others stood there, if these go") {
  // A walker passes the place where a van is stationary from scan 20 to 45. Then the van drives
  // off, or stays. While the walker is at that place, his points are not dynamic.
  for (const bool leaves : {false, true}) {
    Scans scans;
    for (int i = 0; i < 55; ++i) {
      const bool drives = leaves && i > 45;
      ObjectSummary van = drives ? walker(11 + 3 * (i - 45), true, i, i) : walker(11, false, 10, 45);
      make_van(van);
      scans.push_back({});
      if (i < 15) scans.back() = {walking(i, i < 10)};
      if (i >= 10 && i < 15) scans.back()[0].last_hit = 45.0, scans.back()[0].hits = 30.0F;
      if (i >= 20) scans.back() = {van};
    }
    const auto expected = leaves ? kFirst : kNone;
    CHECK(marks(scans)[30] == expected);
    CHECK(marks(scans)[11] == expected);
    // For longer than that, something else is there.
    for (std::size_t i = 10; i < 15; ++i) scans[i][0].hits = 60.0F;
    CHECK(marks(scans)[11].empty());
  }
}

}  // namespace raymoval::raymoval_plus_test
