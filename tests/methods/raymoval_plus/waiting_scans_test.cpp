// SPDX-License-Identifier: MIT
#include "methods/raymoval_plus/online/waiting_scans.h"

#include <catch2/catch.hpp>
#include <vector>

#include "core/error.h"

namespace raymoval::raymoval_plus_test {
using namespace raymoval::raymoval_plus_method;

namespace {

/// For each scan, the number of scans that are known when it is answered. Scans come at `times`;
/// scans that are answered at the end know all.
std::vector<std::size_t> known_scans(double delay, const std::vector<double>& times) {
  WaitingScans waiting(delay);
  std::vector<std::size_t> known;
  const auto answer_first = [&](std::size_t scans) {
    CHECK(waiting.first().scan.index == known.size());  // In their order.
    known.push_back(scans);
    waiting.remove_first();
  };
  for (std::size_t i = 0; i < times.size(); ++i) {
    waiting.tick(times[i]);
    while (waiting.is_overdue()) answer_first(i);
    waiting.add().scan.index = i;
    while (waiting.is_due()) answer_first(i + 1);
  }
  while (!waiting.empty()) answer_first(times.size());
  return known;
}

}  // namespace

TEST_CASE("without a delay each scan is answered from itself and those before") {
  CHECK(known_scans(0.0, {0.0, 0.1, 0.2}) == std::vector<std::size_t>{1, 2, 3});
  CHECK(known_scans(0.0, {5.0, 5.0, 5.0}) == std::vector<std::size_t>{1, 2, 3});
}

TEST_CASE("with a delay each scan knows those that came by then") {
  // Scan 0 uses the scans up to 0.2 s, scan 1 up to 0.3 s; the rest uses all.
  CHECK(known_scans(0.2, {0.0, 0.1, 0.2, 0.3}) == std::vector<std::size_t>{3, 4, 4, 4});
  // Ten tenths are a second, however they round.
  std::vector<double> tenths;
  for (int i = 0; i < 30; ++i) tenths.push_back(i == 0 ? 0.0 : tenths.back() + 0.1);
  const auto known = known_scans(1.0, tenths);
  for (std::size_t i = 0; i < 20; ++i) CHECK(known[i] == i + 11);
}

TEST_CASE("a scan behind a gap is too late for those before it") {
  CHECK(known_scans(0.2, {0.0, 0.1, 9.0, 9.1}) == std::vector<std::size_t>{2, 2, 4, 4});
}

TEST_CASE("scans of one moment wait equally long, and the clock does not go back") {
  CHECK(known_scans(0.1, {0.0, 0.0, 0.1, 0.1}) == std::vector<std::size_t>{3, 3, 4, 4});
  CHECK(known_scans(0.1, {1.0, 0.5, 0.6, 1.1}) == std::vector<std::size_t>{4, 4, 4, 4});
}

TEST_CASE("times that stand still are an error before memory is full") {
  WaitingScans waiting(1.0);
  waiting.tick(3.0);
  CHECK_THROWS_WITH(
      [&] {
        for (int i = 0; i < 1000; ++i) waiting.add();
      }(),
      Catch::Contains("256 scans came within the delay of 1 s") && Catch::Contains("times.txt"));
}

}  // namespace raymoval::raymoval_plus_test
