// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/objects/journeys.h"

#include <algorithm>
#include <catch2/catch.hpp>

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

using Scans = std::vector<std::vector<ObjectSummary>>;

/// A walker of half a metre that moves 0.2 m per scan along x; `dynamic` of 20 points are dynamic.
ObjectSummary walker(int scan, int dynamic, float agree_scans) {
  ObjectSummary object;
  object.center = {0.2 * scan, 0.0, 1.0};
  object.low = object.center - Eigen::Vector3d(0.25, 0.25, 0.7);
  object.high = object.center + Eigen::Vector3d(0.25, 0.25, 0.7);
  object.range = 10.0F;
  object.points = 20;
  object.dynamic = dynamic;
  object.agree_scans = agree_scans;
  object.first_agree = object.last_agree = scan;
  return object;
}

/// The objects at the times of their scans, of which one comes every `period` seconds.
Scans timed(Scans scans, double period) {
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (ObjectSummary& object : scans[i]) object.time_s = period * static_cast<double>(i);
  }
  return scans;
}

std::vector<std::vector<int>> marked_by_tracks(const Scans& scans, double period = 0.1) {
  return objects_on_tracks(timed(scans, period), Parameters{}, RunContext{});
}

/// The clusters that forward tracks mark in the last scan.
std::vector<int> marked_in_last(const Scans& scans, ObjectTracker tracker, double period = 0.1) {
  const Scans at_times = timed(scans, period);
  for (std::size_t i = 0; i < scans.size(); ++i) tracker.follow(i, at_times[i]);
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
    // There are no scans after the last three, so their voxels are not observed as free.
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
  // Scans support it for far longer than half a metre at 0.2 m per scan explains: another object.
  for (auto& objects : scans) objects[0].agree_scans = 60.0F;
  CHECK(marked_by_tracks(scans)[9].empty());
}

TEST_CASE("track_slack says how long scans may agree with what moves on") {
  // 0.71 m of length, twice the tolerance of 0.25 m of supporting returns, and a voxel of 0.2 m
  // pass in 7.04 scans at 0.2 m each. 2.2 times as many and two are 17.5 scans, 2.3 times as
  // many 18.2.
  for (const double slack : {2.2, 2.3}) {
    Parameters parameters;
    parameters.track_slack = slack;
    ObjectTracker tracker(parameters);
    for (int i = 0; i < 8; ++i) {
      tracker.follow(static_cast<std::size_t>(i), {walker(i, i < 7 ? 18 : 0, 18.0F)});
    }
    CHECK(marked_in(7, tracker.finish(), parameters) ==
          (slack > 2.25 ? std::vector{0} : std::vector<int>{}));
  }
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
  // The walker is stationary for 40 scans, in which it is never observed as free, and walks for 10.
  // In the reverse order of time it comes and stays.
  for (const bool comes : {false, true}) {
    for (const float agree_scans : {40.0F, 90.0F}) {
      Scans scans;
      for (int i = 0; i < 50; ++i) {
        const int time = comes ? 49 - i : i;
        const bool stands = time < 40;
        scans.push_back({walker(stands ? 0 : time - 39, stands ? 0 : 18, agree_scans)});
      }
      // Scans support its place for as long as the track was there. If they support it for more
      // than twice as long, the track ran into another object.
      const auto marked = marked_by_tracks(scans);
      const auto of_standing = agree_scans < 50.0F ? std::vector{0} : std::vector<int>{};
      for (std::size_t i = 0; i < 50; ++i) {
        const bool stands = comes ? i >= 10 : i < 40;
        CHECK(marked[i] == (stands ? of_standing : std::vector<int>{}));
      }
    }
  }
}

TEST_CASE(
    "a pole stays whose track somebody who passes takes over, or whom it takes over from him") {
  // A cluster is tracked for 40 scans, and then the walker moves on from there for ten. Or, in the
  // reverse order of time, the walker comes there, and the cluster is tracked on. Scans support the
  // place up to `beyond` scans after the walker should have left, or from as many before it should
  // have come.
  const auto is_marked = [](bool comes, float agree_scans, float free_scans, double beyond) {
    Scans scans;
    for (int i = 0; i < 50; ++i) {
      const int time = comes ? 49 - i : i;
      scans.push_back({walker(time < 40 ? 0 : time - 39, time < 40 ? 0 : 18, agree_scans)});
      scans.back()[0].first_agree = comes ? 10.0 - beyond : 0.0;
      scans.back()[0].last_agree = comes ? 49.0 : 39.0 + beyond;
      scans.back()[0].free_scans = free_scans;
    }
    const auto marked = marked_by_tracks(scans);
    CHECK(marked[20] == marked[25]);
    return marked[25] == std::vector{0};
  };
  // The walker moves 0.2 m per scan and is 0.71 m wide, so it is still at the place for three
  // scans.
  for (const bool comes : {false, true}) {
    CHECK(is_marked(comes, 60.0F, 0.0F, 13.0));  // Scans may support the place around the walker.
    CHECK_FALSE(is_marked(comes, 60.0F, 0.0F, 14.0));
    CHECK_FALSE(is_marked(comes, 60.0F, 3.0F, 20.0));
    CHECK(is_marked(comes, 60.0F, 3.5F, 20.0));  // More free scans: others came there.
    // Five scans more than the 43 in which it is followed there are a quarter of the other 17.
    CHECK_FALSE(is_marked(comes, 48.0F, 0.0F, 20.0));
    CHECK(is_marked(comes, 47.0F, 0.0F, 20.0));
  }
}

TEST_CASE("a pole stays before which somebody came or left for some scans") {
  // A stationary cluster that is dynamic in four of ten scans. It is supported some scans before or
  // after, or both. If it is dynamic until the last scan of its track, no scan should support it
  // long after that; if it is dynamic in the first scans only, it may have come to stay.
  const auto is_marked = [](int every, double before, double after) {
    Scans scans;
    for (int i = 0; i < 10; ++i) {
      const bool is_dynamic = every > 1 ? i % every == 0 : i < 4;
      scans.push_back({walker(0, is_dynamic ? 18 : 0, 20.0F)});
      scans.back()[0].first_agree = -before;
      scans.back()[0].last_agree = 9.0 + after;
    }
    return marked_by_tracks(scans)[5] == std::vector{0};
  };
  for (const int every : {1, 3}) {
    CHECK(is_marked(every, 10.0, 10.0));
    CHECK_FALSE(is_marked(every, 11.0, 11.0));
    CHECK(is_marked(every, 20.0, 10.0));  // It was there before its new track began.
    CHECK_FALSE(is_marked(every, 21.0, 10.0));
    CHECK_FALSE(is_marked(every, 21.0, 0.0));
    CHECK(is_marked(every, 10.0, 20.0));
    CHECK(is_marked(every, 0.0, 10.0));
  }
  CHECK_FALSE(is_marked(3, 10.0, 21.0));
  CHECK(is_marked(1, 10.0, 21.0));
}

TEST_CASE("what waits is in its place however much of it is in sight") {
  // A van waits for 40 scans. At first 2.8 m of it are visible, then less and less behind its
  // front, until that is 0.4 m deep; then it drives off. Its centre shifts by 1.2 m meanwhile.
  for (const float agree_scans : {60.0F, 95.0F}) {
    Scans scans;
    for (int i = 0; i < 50; ++i) {
      const double front = 0.3 * std::max(i - 39, 0);
      const double depth = std::max(2.8 - 0.1 * i, 0.4);
      ObjectSummary van = walker(0, i < 40 ? 0 : 18, agree_scans);
      van.low.x() = front - depth;
      van.high.x() = front;
      van.center.x() = front - depth / 2.0;
      van.low.y() = -0.9;
      van.high.y() = 0.9;
      van.first_agree = 0.0;
      van.last_agree = 39.0;
      scans.push_back({van});
    }
    // It is followed there for 40 scans, and in its place for six more: 92 are twice as many. The
    // scans of the half of its way that its centre shifted alone would be too few for 60.
    const auto marked = marked_by_tracks(scans);
    for (std::size_t i = 0; i < 40; ++i) {
      CHECK(marked[i] == (agree_scans < 90.0F ? std::vector{0} : std::vector<int>{}));
    }
  }
}

TEST_CASE("a parked car stays whose track something much smaller takes over") {
  // A walker of 0.71 m comes in ten scans; the object that is stationary for the next 40 scans is
  // 1.56 or 1.92 m wide. 1.5 times 0.71 m and 0.6 m are 1.66 m.
  for (const bool is_larger : {false, true}) {
    Scans scans;
    for (int i = 0; i < 50; ++i) {
      scans.push_back({walker(std::min(i, 10), i < 10 ? 18 : 0, 40.0F)});
      if (i < 10) continue;
      ObjectSummary& standing = scans.back()[0];
      const Eigen::Vector3d half =
          is_larger ? Eigen::Vector3d(0.75, 0.6, 0.7) : Eigen::Vector3d(0.6, 0.5, 0.7);
      standing.low = standing.center - half;
      standing.high = standing.center + half;
      standing.first_agree = 10.0;
      standing.last_agree = 49.0;
    }
    const auto marked = marked_by_tracks(scans);
    for (std::size_t i = 10; i < 50; ++i) {
      CHECK(marked[i] == (is_larger ? std::vector<int>{} : std::vector{0}));
    }
  }
}

TEST_CASE("what stands is one thing in all scans if in enough of them it came or leaves") {
  // A person who is stationary for ten scans is dynamic in the first three or two of them; later
  // only the upper half is in view, which no scan observed as free.
  for (const int dynamic : {2, 3}) {
    for (const float agree_scans : {22.0F, 23.0F}) {
      Scans scans;
      for (int i = 0; i < 10; ++i) {
        scans.push_back({walker(0, i < dynamic ? 18 : 0, agree_scans)});
        if (i >= dynamic) scans.back()[0].low.z() += 0.7;
      }
      const auto marked = marked_by_tracks(scans);
      // 22 scans are twice the length of the track, and two more.
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
  // A van of 4 m drives 1.5 m per scan, farther than any slow object.
  Scans scans;
  for (int i = 0; i < 8; ++i) {
    scans.push_back({walker(0, i < 5 ? 18 : 0, 1.0)});
    ObjectSummary& van = scans.back()[0];
    van.center.x() = 10.0 + 1.5 * i;
    make_van(van);
  }
  const auto last_marked = [&](double first_speed, double period = 0.1) {
    const ObjectTracker tracker(Parameters{}, {.first_speed = first_speed});
    return marked_in_last(scans, tracker, period);
  };
  CHECK(last_marked(0.0).empty());
  CHECK(last_marked(14.0).empty());  // 1.4 m a scan.
  CHECK(last_marked(40.0) == std::vector{0});
  CHECK(marked_by_tracks(scans).back() == std::vector{0});
  // Twice or half as many scans a second: the speed counts, not the step.
  CHECK(last_marked(14.0, 0.2) == std::vector{0});
  CHECK(last_marked(28.0, 0.05).empty());
  // A place with long support was occupied before, so it is no fast object.
  for (std::size_t i = 1; i < 8; ++i) scans[i][0].agree_scans = 20.0F;
  CHECK(last_marked(40.0).empty());
}

TEST_CASE("a slow object is followed though a long first step leads to another one") {
  // A walker is occluded in the second scan, in which a person is stationary 2 m ahead. Only three
  // scans observe his place as free, so that all of them must be of his track.
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
  // A van drives 2 m per scan along x, and is stationary from the fifth scan on at a place that was
  // never observed as free. It is expected 2 m ahead then, which is less than
  // 0.6 m + 4.5 x 0.5^2 m + 0.35 x 2 m, but more than 0.6 m + 4.5 x 0.1^2 m + 0.35 x 2 m.
  for (const double period : {0.1, 0.5}) {
    Scans scans;
    for (int i = 0; i < 8; ++i) {
      scans.push_back({walker(10 * std::min(i, 4), i < 5 ? 18 : 0, 4.0)});
      make_van(scans.back()[0]);
    }
    const bool is_followed = period == 0.5;
    CHECK(marked_by_tracks(scans, period)[7] ==
          (is_followed ? std::vector{0} : std::vector<int>{}));
  }
}

TEST_CASE("an object is followed though a wide gate leads to another one") {
  // A walker is occluded in the fourth scan, in which a stationary person is 1.5 m beside his
  // expected place. With a wide gate alone, his track would take the other person, and the walker
  // would be kept.
  Scans scans;
  for (int i = 0; i < 10; ++i) {
    scans.push_back({walker(i, i < 3 ? 18 : 0, i == 3 ? 1.0 : 4.0)});
    if (i == 3) scans.back()[0].center.y() += 1.5;
  }
  const auto last_marked = [&](const TrackGate& gate) {
    return marked_in_last(scans, ObjectTracker(Parameters{}, {.gate = gate}), 0.5);
  };
  CHECK(last_marked(kWideGate).empty());
  CHECK(last_marked(kGate) == std::vector{0});
  CHECK(marked_by_tracks(scans, 0.5)[9] == std::vector{0});
}

TEST_CASE("what waits is followed though others pass before it for some scans") {
  // A walker is stationary for 20 scans, is occluded in some of them, and walks for 7, in which he
  // is dynamic.
  for (const int hidden : {10, 11}) {
    Scans scans(27);
    for (int i = 0; i < 27; ++i) {
      if (i < 16 && i >= 16 - hidden) continue;
      scans[static_cast<std::size_t>(i)] = {walker(std::max(i - 19, 0), i < 20 ? 0 : 18, 10.0F)};
    }
    const auto marked = marked_by_tracks(scans);
    CHECK(marked[18] == std::vector{0});
    CHECK(marked[2] == (hidden == 10 ? std::vector{0} : std::vector<int>{}));
  }
}

TEST_CASE("what is divided in some scans is followed as it was before") {
  // A van of 4 m is stationary for 8 scans and drives off by 0.6 m per scan. In its first three
  // scans its rear is still at its first place, and is divided from its front.
  const auto van = [](int scan, int dynamic) {
    ObjectSummary object = walker(3 * std::max(scan - 7, 0), dynamic, scan < 11 ? 6.0F : 2.0F);
    make_van(object);
    return object;
  };
  Scans scans;
  for (int i = 0; i < 16; ++i) {
    scans.push_back({van(i, i < 8 ? 0 : 18)});
    if (i < 8 || i > 10) continue;
    ObjectSummary whole = van(i, 8);
    whole.is_undivided = true;
    whole.cluster = 2;
    ObjectSummary rear = whole, front = whole;
    rear.high.x() = front.low.x() = whole.center.x();
    rear.center.x() -= 1.0;
    front.center.x() += 1.0;
    rear.dynamic = 0;
    front.points = front.dynamic = 8;
    rear.is_undivided = front.is_undivided = false;
    rear.cluster = 0;
    front.cluster = 1;
    scans.back() = {rear, front, whole};
  }
  const auto marked = marked_by_tracks(scans);
  for (std::size_t i = 0; i < 8; ++i) CHECK(marked[i] == std::vector{0});
  for (std::size_t i = 8; i < 11; ++i) CHECK(marked[i] == std::vector{2});
  for (const bool also_undivided : {false, true}) {
    ObjectTracker tracker(Parameters{},
                          {.first_speed = kFirstSpeed, .also_undivided = also_undivided});
    const Scans at_times = timed(scans, 0.1);
    for (std::size_t i = scans.size(); i > 0; --i) tracker.follow(i - 1, at_times[i - 1]);
    CHECK(marked_in(0, tracker.finish(), Parameters{}).empty() != also_undivided);
  }
}

TEST_CASE("scans agree with what passes for as long as others stood there, if these go") {
  // A walker passes the place where a van is stationary from scan 20 to 45. Then the van drives
  // off, or stays. While the walker is at that place, his points are not dynamic.
  for (const bool leaves : {false, true}) {
    Scans scans;
    for (int i = 0; i < 55; ++i) {
      ObjectSummary van = walker(11 + 3 * std::max(leaves ? i - 45 : 0, 0), 0, 30.0F);
      if (leaves && i > 45) {
        van.dynamic = 18;
        van.agree_scans = 2.0F;
      }
      make_van(van);
      scans.push_back({});
      if (i < 15) scans.back() = {walker(i, i < 10 ? 18 : 0, i < 10 ? 4.0F : 30.0F)};
      if (i >= 20) scans.back() = {van};
    }
    const auto marked = marked_by_tracks(scans);
    const auto expected = leaves ? std::vector{0} : std::vector<int>{};
    CHECK(marked[30] == expected);
    CHECK(marked[11] == expected);
    // For longer than that, something else is there.
    for (std::size_t i = 10; i < 15; ++i) scans[i][0].agree_scans = 60.0F;
    CHECK(marked_by_tracks(scans)[11].empty());
  }
}

}  // namespace raymoval::raymoval_plus_test
