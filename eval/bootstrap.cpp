// SPDX-License-Identifier: MIT
#include "eval/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace raymoval {
namespace {

constexpr std::size_t kFewestScans = 4;
using Counts = std::vector<std::int64_t>;

void add(const Counts& from, Counts& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
}

/// Counts of the block that begins at each scan; blocks are circular.
std::vector<Counts> block_sums(const std::vector<Counts>& scans, std::size_t length) {
  std::vector<Counts> sums(scans.size(), Counts(scans.front().size(), 0));
  for (std::size_t start = 0; start < scans.size(); ++start) {
    for (std::size_t i = 0; i < length; ++i) add(scans[(start + i) % scans.size()], sums[start]);
  }
  return sums;
}

Interval interval_of(const std::string& name, std::vector<double>& values,
                     const BootstrapOptions& options) {
  Interval interval{name, {}, {}};
  if (2 * values.size() < static_cast<std::size_t>(options.replicates)) {
    interval.undefined_reason = "the rate is undefined in most replicates";
    return interval;
  }
  std::sort(values.begin(), values.end());
  const double tail = 0.5 * (1.0 - options.level) * static_cast<double>(values.size());
  const auto skipped = static_cast<std::size_t>(std::floor(tail + 1e-9));
  interval.low = values[skipped];
  interval.high = values[values.size() - 1 - skipped];
  return interval;
}

}  // namespace

std::size_t bootstrap_block(std::size_t scans) {
  std::size_t length = 1;
  while (length * length < scans) ++length;
  return length;
}

Intervals bootstrap(const std::vector<Counts>& counts_by_scan,
                    const std::function<std::vector<Rate>(const Counts&)>& rates_of,
                    const BootstrapOptions& options) {
  const std::size_t scans = counts_by_scan.size();
  Intervals result{{}, scans, bootstrap_block(scans), options};
  if (scans == 0) return result;
  const std::vector<Rate> rates = rates_of(Counts(counts_by_scan.front().size(), 0));
  if (scans < kFewestScans) {
    for (const Rate& rate : rates) {
      result.rates.push_back({rate.name, {}, {}, "fewer than 4 scans are too few for an interval"});
    }
    return result;
  }
  const std::size_t whole = scans / result.block_scans;
  const std::size_t rest = scans % result.block_scans;
  const std::vector<Counts> blocks = block_sums(counts_by_scan, result.block_scans);
  const std::vector<Counts> last = block_sums(counts_by_scan, rest);
  // Only the engine's own numbers are used: the library's distributions differ between platforms.
  std::mt19937_64 random(options.seed);
  std::vector<std::vector<double>> values(rates.size());
  for (int replicate = 0; replicate < options.replicates; ++replicate) {
    Counts sums(counts_by_scan.front().size(), 0);
    for (std::size_t i = 0; i < whole; ++i) add(blocks[random() % scans], sums);
    if (rest > 0) add(last[random() % scans], sums);
    const std::vector<Rate> drawn = rates_of(sums);
    for (std::size_t i = 0; i < rates.size(); ++i) {
      if (drawn[i].value) values[i].push_back(*drawn[i].value);
    }
  }
  for (std::size_t i = 0; i < rates.size(); ++i)
    result.rates.push_back(interval_of(rates[i].name, values[i], options));
  return result;
}

}  // namespace raymoval
