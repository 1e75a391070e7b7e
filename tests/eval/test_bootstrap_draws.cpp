// SPDX-License-Identifier: MIT
// What the bootstrap draws, and which of the draws an interval is made of.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "eval/bootstrap.h"

namespace raymoval::test {
namespace {

using Sums = std::vector<std::int64_t>;

std::vector<Sums> single_counts(const Sums& counts) {
  std::vector<Sums> scans;
  for (const std::int64_t count : counts) scans.push_back({count});
  return scans;
}

/// The sum itself as a rate. It stores all sums except the first, which requests the names.
class SumRate {
 public:
  std::vector<Rate> operator()(const Sums& sums) {
    if (asked_) drawn.push_back(static_cast<double>(sums[0]));
    asked_ = true;
    return {{"sum", static_cast<double>(sums[0])}};
  }
  std::vector<double> drawn;

 private:
  bool asked_ = false;
};

}  // namespace

TEST_CASE("an interval is of the draws that are left when both tails are cut off", "[bootstrap]") {
  for (const double level : {0.95, 0.9, 0.5, 0.999}) {
    for (const int replicates : {1000, 999, 7}) {
      CAPTURE(level, replicates);
      SumRate rate;
      const Intervals result =
          bootstrap(single_counts({1, 5, 25, 125, 625, 3125, 15625}),
                    [&](const Sums& sums) { return rate(sums); }, {replicates, level, 11});
      REQUIRE(rate.drawn.size() == static_cast<std::size_t>(replicates));
      std::sort(rate.drawn.begin(), rate.drawn.end());
      // At a level of 95 % 25 of 1,000 are cut off at each end: the 26th from either end is left.
      const auto cut = static_cast<std::size_t>(
          std::lround(std::floor(std::round(1e6 * (1.0 - level) / 2.0) * replicates / 1e6)));
      CHECK(result.rates[0].low == rate.drawn[cut]);
      CHECK(result.rates[0].high == rate.drawn[rate.drawn.size() - 1 - cut]);
    }
  }
}

TEST_CASE("the draws are those of the seed, so that intervals can be made again", "[bootstrap]") {
  for (const std::size_t scans : {4U, 7U, 9U, 10U}) {
    CAPTURE(scans);
    Sums counts;
    for (std::size_t i = 0; i < scans; ++i) counts.push_back(static_cast<std::int64_t>(i * i + 1));
    SumRate rate;
    bootstrap(single_counts(counts), [&](const Sums& sums) { return rate(sums); }, {50, 0.9, 77});
    // By single scans instead of sums of blocks.
    const std::size_t length = bootstrap_block(scans);
    std::mt19937_64 random(77);
    for (const double drawn : rate.drawn) {
      std::int64_t sum = 0;
      for (std::size_t left = scans; left > 0;) {
        const std::size_t taken = std::min(left, length), first = random() % scans;
        for (std::size_t i = 0; i < taken; ++i) sum += counts[(first + i) % scans];
        left -= taken;
      }
      CHECK(drawn == static_cast<double>(sum));
    }
  }
}

TEST_CASE("four scans are enough for an interval, three and none are not", "[bootstrap]") {
  const auto of = [](const Sums& counts) {
    SumRate rate;
    return bootstrap(single_counts(counts), [&](const Sums& sums) { return rate(sums); });
  };
  CHECK(of({1, 1, 1, 1}).rates.at(0).low == 4.0);
  const Intervals three = of({1, 1, 1});
  CHECK_FALSE(three.rates.at(0).low);
  CHECK(three.rates.at(0).name == "sum");
  CHECK(three.rates.at(0).undefined_reason == "fewer than 4 scans are too few for an interval");
  CHECK(three.scans == 3);
  const Intervals none = of({});
  CHECK(none.rates.empty());
  CHECK(none.scans == 0);
  CHECK(none.block_scans == 1);
}

TEST_CASE("a rate that is undefined in more than half of the replicates has no interval",
          "[bootstrap]") {
  const auto defined_in = [](int replicates) {
    int call = 0;
    return bootstrap(single_counts({1, 1, 1, 1}),
                     [&](const Sums&) -> std::vector<Rate> {
                       const bool defined = call > 0 && call <= replicates;
                       ++call;
                       return {{"now and then", defined ? std::optional(1.0) : std::nullopt}};
                     })
        .rates.at(0);
  };
  CHECK(defined_in(500).low == 1.0);
  CHECK_FALSE(defined_in(499).low);
  CHECK(defined_in(499).undefined_reason == "the rate is undefined in most replicates");
}

}  // namespace raymoval::test
