// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/tracks.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace raymoval;
using namespace raymoval::raymoval_plus_method;

namespace {

using Scans = std::vector<std::vector<ObjectSummary>>;

/// A walker of half a metre who moves 0.2 m a scan along x; `dynamic` of 20 points are dynamic.
ObjectSummary walker(int scan, int dynamic, float agree_scans) {
  ObjectSummary object;
  object.center = {0.2 * scan, 0.0, 1.0};
  object.low = object.center - Eigen::Vector3d(0.25, 0.25, 0.7);
  object.high = object.center + Eigen::Vector3d(0.25, 0.25, 0.7);
  object.range = 10.0F;
  object.points = 20;
  object.dynamic = dynamic;
  object.agree_scans = agree_scans;
  return object;
}

std::vector<std::vector<int>> marked_by_tracks(const Scans& scans) {
  return objects_on_tracks(scans, Parameters{}, RunContext{});
}

/// What the tracks of one that goes forward mark in the last scan.
std::vector<int> marked_in_last(const Scans& scans, ObjectTracker tracker) {
  for (std::size_t i = 0; i < scans.size(); ++i) tracker.follow(i, scans[i]);
  return marked_in(scans.size() - 1, tracker.finish(), Parameters{});
}

/// Makes an object as large as a van of 4 m.
void make_van(ObjectSummary& object) {
  object.low = object.center - Eigen::Vector3d(2.0, 0.8, 0.7);
  object.high = object.center + Eigen::Vector3d(2.0, 0.8, 0.7);
}

}  // namespace

TEST_CASE("an object is followed past its last evidence, a standing one is not") {
  Scans scans;
  for (int i = 0; i < 10; ++i) {
    // Nothing was seen after the last three scans, so their voxels are not found free.
    scans.push_back({walker(i, i < 7 ? 18 : 0, 4.0), walker(0, 0, 10.0)});
    scans.back()[1].center.y() += 5.0;
  }
  const auto marked = marked_by_tracks(scans);
  for (int i = 0; i < 10; ++i) {
    CHECK(marked[static_cast<std::size_t>(i)] == (i < 7 ? std::vector<int>{} : std::vector{0}));
  }
  // Scan by scan: the walker of scan 7 is marked by its own past.
  ObjectTracker tracker{Parameters{}};
  for (std::size_t i = 0; i < 8; ++i) tracker.follow(i, scans[i]);
  CHECK(marked_in(7, tracker.finish(), Parameters{}) == std::vector{0});
  // Scans agree on it for far longer than half a metre at 0.2 m a scan explains: something else.
  for (auto& objects : scans) objects[0].agree_scans = 60.0F;
  CHECK(marked_by_tracks(scans)[9].empty());
}

TEST_CASE("an object is followed backward in time to before its first evidence") {
  Scans scans;
  for (int i = 0; i < 10; ++i) scans.push_back({walker(i, i < 3 ? 0 : 18, 4.0)});
  const auto marked = marked_by_tracks(scans);
  for (std::size_t i = 0; i < 10; ++i) {
    CHECK(marked[i] == (i < 3 ? std::vector{0} : std::vector<int>{}));
  }
}

TEST_CASE("a track may miss two scans, and not three") {
  // The walker is found in scans 0 to 5 and once more, undecided, after a gap.
  for (const int missed : {2, 3}) {
    Scans scans;
    for (int i = 0; i < 6; ++i) scans.push_back({walker(i, 18, 4.0)});
    scans.resize(static_cast<std::size_t>(6 + missed));
    scans.push_back({walker(6 + missed, 0, 4.0)});
    CHECK(marked_by_tracks(scans).back() == (missed == 2 ? std::vector{0} : std::vector<int>{}));
  }
}

TEST_CASE("what waits before it leaves, or comes and stays, is one thing with what moved") {
  // The walker stands for 40 scans, in which nothing is seen through it, and walks for 10. In the
  // other order of time it comes and stays.
  for (const bool comes : {false, true}) {
    for (const float agree_scans : {40.0F, 90.0F}) {
      Scans scans;
      for (int i = 0; i < 50; ++i) {
        const int time = comes ? 49 - i : i;
        const bool stands = time < 40;
        scans.push_back({walker(stands ? 0 : time - 39, stands ? 0 : 18, agree_scans)});
      }
      // Scans agree with its place for as long as it was followed there. If they agree for more
      // than twice as long, it is something else that the track ran into.
      const auto marked = marked_by_tracks(scans);
      const auto of_standing = agree_scans < 50.0F ? std::vector{0} : std::vector<int>{};
      for (std::size_t i = 0; i < 50; ++i) {
        const bool stands = comes ? i >= 10 : i < 40;
        CHECK(marked[i] == (stands ? of_standing : std::vector<int>{}));
      }
    }
  }
}

TEST_CASE("what stands is one thing in all scans if in enough of them it came or leaves") {
  // Who stands for ten scans is dynamic in the first three or two of them; later only his upper
  // half is in view, through which no scan ever saw.
  for (const int dynamic : {2, 3}) {
    for (const float agree_scans : {22.0F, 23.0F}) {
      Scans scans;
      for (int i = 0; i < 10; ++i) {
        scans.push_back({walker(0, i < dynamic ? 18 : 0, agree_scans)});
        if (i >= dynamic) scans.back()[0].low.z() += 0.7;
      }
      const auto marked = marked_by_tracks(scans);
      // 22 scans are twice as many as he was followed, and two more.
      const bool is_one = dynamic == 3 && agree_scans == 22.0F;
      for (std::size_t i = 3; i < 10; ++i) {
        CHECK(marked[i] == (is_one ? std::vector{0} : std::vector<int>{}));
      }
    }
  }
  // Three of thirteen scans are too few.
  Scans scans;
  for (int i = 0; i < 13; ++i) scans.push_back({walker(0, i < 3 ? 18 : 0, 4.0)});
  CHECK(marked_by_tracks(scans)[10].empty());
}

TEST_CASE("a whole thing is dynamic though most of its points are not") {
  ObjectSummary object = walker(0, 8, 4.0);
  CHECK_FALSE(is_dynamic(object, Parameters{}));
  object.is_whole = true;
  CHECK(is_dynamic(object, Parameters{}));
}

TEST_CASE("an object that did not move, or changed its size, marks nothing") {
  Scans standing, growing;
  for (int i = 0; i < 10; ++i) {
    standing.push_back({walker(0, i < 2 ? 18 : 0, 4.0)});
    growing.push_back({walker(i, i < 7 ? 18 : 0, 4.0)});
    if (i >= 7) growing.back()[0].high.z() += 2.0;  // 2 m more than 0.6 m + 0.3 x 3.4 m.
  }
  CHECK(marked_by_tracks(standing)[9].empty());
  CHECK(marked_by_tracks(growing)[7].empty());
}

TEST_CASE("a fast object is followed from its first step on if that is allowed") {
  // A van of 4 m drives 1.5 m a scan, which no slow thing does between two scans.
  Scans scans;
  for (int i = 0; i < 8; ++i) {
    scans.push_back({walker(0, i < 5 ? 18 : 0, 1.0)});
    ObjectSummary& van = scans.back()[0];
    van.center.x() = 10.0 + 1.5 * i;
    make_van(van);
  }
  const auto last_marked = [&](double first_step) {
    return marked_in_last(scans, ObjectTracker(Parameters{}, first_step));
  };
  CHECK(last_marked(0.0).empty());
  CHECK(last_marked(1.4).empty());
  CHECK(last_marked(4.0) == std::vector{0});
  CHECK(marked_by_tracks(scans).back() == std::vector{0});
  // What scans agree with for long stood there before, and is no fast thing.
  for (std::size_t i = 1; i < 8; ++i) scans[i][0].agree_scans = 20.0F;
  CHECK(last_marked(4.0).empty());
}

TEST_CASE("a slow object is followed though a long first step leads to another one") {
  // A walker is hidden in the second scan, where somebody stands 2 m ahead. Only three scans see
  // through his place, so that all of them must be of his track.
  Scans scans;
  for (int i = 0; i < 10; ++i) {
    const bool is_dynamic = i == 0 || i == 2 || i == 3;
    scans.push_back({i == 1 ? walker(10, 0, 1.0) : walker(i, is_dynamic ? 18 : 0, 4.0)});
  }
  const auto marked = marked_by_tracks(scans);
  CHECK(marked[1].empty());
  for (std::size_t i = 4; i < 10; ++i) CHECK(marked[i] == std::vector{0});
}

TEST_CASE("what brakes between scans half a second apart is followed") {
  // A van drives 2 m a scan along x, and stands from the fifth scan on, where nothing was seen
  // through. It is expected 2 m ahead then, which is less than 0.6 m + 4.5 x 0.5^2 m + 0.35 x 2 m,
  // but more than 0.6 m + 4.5 x 0.1^2 m + 0.35 x 2 m.
  for (const double period : {0.1, 0.5}) {
    Scans scans;
    for (int i = 0; i < 8; ++i) {
      scans.push_back({walker(10 * std::min(i, 4), i < 5 ? 18 : 0, 4.0)});
      make_van(scans.back()[0]);
      scans.back()[0].time_s = period * i;
    }
    const bool is_followed = period == 0.5;
    CHECK(marked_by_tracks(scans)[7] == (is_followed ? std::vector{0} : std::vector<int>{}));
  }
}

TEST_CASE("an object is followed though a wide gate leads to another one") {
  // A walker is hidden in the fourth scan, where somebody stands 1.5 m beside where he should be.
  // With a wide gate alone his track would go to the other one, and he would stay.
  Scans scans;
  for (int i = 0; i < 10; ++i) {
    scans.push_back({walker(i, i < 3 ? 18 : 0, i == 3 ? 1.0 : 4.0)});
    if (i == 3) scans.back()[0].center.y() += 1.5;
    scans.back()[0].time_s = 0.5 * i;
  }
  const auto last_marked = [&](const TrackGate& gate) {
    return marked_in_last(scans, ObjectTracker(Parameters{}, 0.0, gate));
  };
  CHECK(last_marked(kWideGate).empty());
  CHECK(last_marked(kGate) == std::vector{0});
  CHECK(marked_by_tracks(scans)[9] == std::vector{0});
}
