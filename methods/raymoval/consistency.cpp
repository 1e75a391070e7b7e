// SPDX-License-Identifier: MIT
#include "methods/raymoval/consistency.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/parallel.h"
#include "methods/raymoval/kernels/image_kernels.h"
#include "methods/raymoval/kernels/scan_kernels.h"

namespace raymoval::raymoval_method {

Mask check_consistency(const ProjectedScan& scan, const std::vector<float>& map_reference,
                       const RangeMargin& margin, int threads) {
  Mask dynamic(scan.range.size());
  const kernels::ScanKernels kernel = kernels::best_scan_kernels();
  kernels::ConsistencyCheck job;
  job.range = scan.range.data();
  job.bin = scan.bin.data();
  job.reference = map_reference.data();
  job.tau0 = margin.tau0;
  job.tau1 = margin.tau1;
  job.dynamic = dynamic.data();
  parallel_chunks(threads, dynamic.size(), 8192, [&](std::size_t begin, std::size_t end) {
    const std::size_t middle = begin + (end - begin) / kernel.lanes * kernel.lanes;
    kernel.check(job, begin, middle);
    for (std::size_t k = middle; k < end; ++k) {
      if (scan.bin[k] < 0) continue;
      const float reference = map_reference[static_cast<std::size_t>(scan.bin[k])];
      const float range = scan.range[k];
      dynamic[k] = reference != kNoRange && reference - range > margin.at(range) ? 1 : 0;
    }
  });
  return dynamic;
}

double grazing_distance(double vertical, double height, double limit) {
  return std::min(limit, height / std::max(std::abs(vertical), 1e-9));
}

std::vector<SeenThrough> find_seen_through(const ProjectedScan& scan,
                                           const BinWindow& neighbourhood,
                                           const FirstHitImage& first_hit,
                                           const std::vector<float>& map_reference,
                                           const RangeMargin& margin, int threads) {
  constexpr std::size_t kGrain = 8192;
  constexpr double kRounding = 1e-3;  // Of the quick test in float, generously.
  const std::size_t bins = scan.minimum_range.size();
  std::vector<std::vector<SeenThrough>> parts((bins + kGrain - 1) / kGrain);
  const auto check = [&](std::size_t bin, float nearest, std::vector<SeenThrough>& found) {
    if (scan.minimum_range[bin] == kNoRange || first_hit.range[bin] == kNoRange) return;
    if (nearest == kernels::kUnknown) {
      nearest = windowed_minimum(scan.minimum_range, neighbourhood, static_cast<int>(bin));
    }
    const double reference = map_reference[bin];
    const double seen_to = nearest;
    if (seen_to - reference > margin.at(reference) &&
        seen_to - first_hit.range[bin] > margin.tau0) {
      found.push_back({static_cast<int>(bin), nearest});
    }
  };
  const kernels::ImageKernels kernel = kernels::best_image_kernels();
  kernels::SuspectSearch search;
  search.own = scan.minimum_range.data();
  search.columns = neighbourhood.grid.azimuth_bins;
  search.rows = neighbourhood.grid.elevation_bins;
  search.azimuth_radius = neighbourhood.azimuth_radius;
  search.elevation_radius = neighbourhood.elevation_radius;
  search.first_hit = first_hit.range.data();
  search.reference = map_reference.data();
  search.tau0 = static_cast<float>(margin.tau0 - kRounding);
  search.tau1 = static_cast<float>(margin.tau1 * (1.0 - kRounding));
  parallel_chunks(threads, bins, kGrain, [&](std::size_t begin, std::size_t end) {
    auto& found = parts[begin / kGrain];
    std::size_t bin = begin;
    std::array<float, 16> nearest;
    for (; bin + 16 <= end; bin += 16) {
      std::uint32_t left = kernel.suspects(search, bin, nearest.data());
      for (; left != 0; left &= left - 1) {
        const auto at = static_cast<std::size_t>(std::countr_zero(left));
        check(bin + at, nearest[at], found);
      }
    }
    for (; bin < end; ++bin) check(bin, kernels::kUnknown, found);
  });
  std::vector<SeenThrough> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<int> find_no_return(const std::vector<float>& nearest_return,
                                const FirstHitImage& first_hit, const AngularGrid& grid,
                                const SensorModel& sensor, double maximum_range) {
  std::vector<int> bins;
  for (std::size_t bin = 0; bin < nearest_return.size(); ++bin) {
    const int number = static_cast<int>(bin);
    if (nearest_return[bin] != kNoRange || !(first_hit.range[bin] <= maximum_range)) continue;
    const double azimuth = grid.azimuth_centre(grid.azimuth_of(number));
    const double elevation = grid.elevation_centre(grid.elevation_of(number));
    if (sensor.sees(azimuth, elevation)) bins.push_back(number);
  }
  return bins;
}

}  // namespace raymoval::raymoval_method
