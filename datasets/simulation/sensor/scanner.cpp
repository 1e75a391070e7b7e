// SPDX-License-Identifier: MIT
#include "datasets/simulation/sensor/scanner.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "datasets/simulation/shapes/random.h"

namespace raymoval::simulated {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kRollingSamples = 9;      // of the motion within a sweep
constexpr std::size_t kExtraBeams = 2;  // beside the middle one, if a beam meets an edge

std::uint64_t word(const Scanner::Options& options, Purpose purpose, std::size_t scan,
                   std::size_t shot) {
  return mix_all({options.seed, static_cast<std::uint64_t>(purpose), scan, shot});
}

/// `direction` rotated by small angles about two axes.
Vector3d nudged(const Vector3d& direction, double first, double second) {
  const Vector3d helper = std::abs(direction.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d u = direction.cross(helper).normalized();
  return (direction + first * u + second * direction.cross(u)).normalized();
}

}  // namespace

Scanner::Scanner(const World& world, const SensorFile& sensor, SensorPose pose, Options options,
                 int threads)
    : world_(world),
      sensor_(sensor),
      pose_(std::move(pose)),
      options_(options),
      tracer_(world, sensor.range_m.high + 1.0, threads) {}

Scanner::Aim Scanner::aim(std::size_t index) const {
  Aim aim;
  aim.shots = sensor_.shots(index, options_.seed);
  if (!options_.noise_free && sensor_.direction_noise > 0.0) {
    for (std::size_t i = 0; i < aim.shots.size(); ++i) {
      const std::uint64_t random = word(options_, Purpose::kSensor, index, i);
      aim.shots[i].direction =
          nudged(aim.shots[i].direction, sensor_.direction_noise * to_normal(random),
                 sensor_.direction_noise * to_normal(mix(random)));
    }
  }
  const double time = static_cast<double>(index) * sensor_.period_s;
  const Isometry3d reference = pose_(time);
  if (options_.rolling != Rolling::kNone) {
    for (int k = 0; k < kRollingSamples; ++k) {
      const double share = static_cast<double>(k) / (kRollingSamples - 1) - 0.5;
      aim.frames.push_back(reference.inverse() * pose_(time + share * sensor_.period_s));
    }
  }
  aim.rays.reserve(aim.shots.size());
  for (const Shot& shot : aim.shots) {
    Ray ray;
    if (aim.frames.empty()) {
      ray.direction = reference.linear() * shot.direction;
    } else {
      const Isometry3d moved = motion_at(aim, shot.time_s);
      ray.origin = reference.linear() * moved.translation();
      ray.direction = reference.linear() * (moved.linear() * shot.direction);
      ray.time = static_cast<float>(std::clamp(shot.time_s / sensor_.period_s + 0.5, 0.0, 1.0));
    }
    aim.rays.push_back(ray);
  }
  return aim;
}

/// Motion of the sensor since the reference time, between the two nearest samples.
Isometry3d Scanner::motion_at(const Aim& aim, double time_s) const {
  const double place = std::clamp(time_s / sensor_.period_s + 0.5, 0.0, 1.0) *
                       static_cast<double>(kRollingSamples - 1);
  const auto k = std::min(static_cast<std::size_t>(place), aim.frames.size() - 2);
  const double share = place - static_cast<double>(k);
  const Isometry3d& a = aim.frames[k];
  const Isometry3d& b = aim.frames[k + 1];
  Isometry3d motion = Isometry3d::Identity();
  motion.linear() = Eigen::Quaterniond(a.linear())
                        .slerp(share, Eigen::Quaterniond(b.linear()))
                        .toRotationMatrix();
  motion.translation() = a.translation() + share * (b.translation() - a.translation());
  return motion;
}

/// Returned light, in units of a white target at 1 m. Rough surfaces fall off slower with the angle
/// than Lambert's law: the square root fits the range of KITTI's sensor on the road.
double Scanner::signal(const Hit& hit) const {
  // The extinction that leaves 5 % of light over the visibility, there and back.
  const double air = std::exp(2.0 * std::log(0.05) * hit.range / world_.air().visibility_m);
  return air * properties(hit.material).reflectivity * std::sqrt(hit.cosine) /
         std::max(1.0, hit.range * hit.range);
}

/// Continues shots that pass a pane to the surface behind it.
void Scanner::pass_glass(const RayTracer::Moment& moment, const std::vector<Ray>& rays,
                         std::size_t index, std::uint64_t salt, std::vector<Hit>& hits) const {
  constexpr double kBehind = 1e-4;  // metres; skips the pane itself
  constexpr std::size_t kMostPanes = 8;
  if (world_.air().glass_through <= 0.0) return;
  std::vector<std::size_t> at(hits.size());
  std::iota(at.begin(), at.end(), std::size_t{0});
  for (std::size_t pane = 0; pane < kMostPanes && !at.empty(); ++pane) {
    std::erase_if(at, [&](std::size_t i) {
      if (!hits[i].found() || hits[i].material != Material::kGlass) return true;
      const std::uint64_t random = word(options_, Purpose::kGlass, index, mix_all({salt, pane, i}));
      return to_unit(random) >= world_.air().glass_through;
    });
    std::vector<Ray> onward;
    for (const std::size_t i : at) {
      onward.push_back(rays[i]);
      onward.back().origin += (hits[i].range + kBehind) * rays[i].direction;
    }
    std::vector<Hit> behind(at.size());
    moment.trace(onward, behind);
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double before = hits[at[k]].range + kBehind;
      hits[at[k]] = behind[k];
      if (behind[k].found()) hits[at[k]].range += before;
    }
  }
}

/// Range of a drop before `hit` that returns like a surface, if there is one.
std::optional<double> Scanner::echo(const Hit& hit, std::size_t index, std::size_t shot) const {
  const Air& air = world_.air();
  if (options_.noise_free || air.echo_share <= 0.0) return std::nullopt;
  const std::uint64_t random = word(options_, Purpose::kEcho, index, shot);
  if (to_unit(random) >= air.echo_share) return std::nullopt;
  const double range = sensor_.range_m.low - air.echo_range_m * std::log1p(-to_unit(mix(random)));
  if (range > sensor_.range_m.high || (hit.found() && range >= hit.range)) return std::nullopt;
  return range;
}

bool Scanner::returns(const Hit& hit, std::uint64_t random) const {
  if (hit.range < sensor_.range_m.low || hit.range > sensor_.range_m.high) return false;
  if (options_.noise_free || hit.material == Material::kPerfect) return true;
  if (to_unit(mix(random)) < properties(hit.material).mirror) return false;
  const double limit = 0.1 / (sensor_.range_at_10_percent_m * sensor_.range_at_10_percent_m);
  const double ratio = signal(hit) / limit;
  const double cube = ratio * ratio * ratio;
  return to_unit(random) < (1.0 - sensor_.dropout) * cube / (1.0 + cube);
}

/// Blends the hits of a beam. Surfaces within a pulse length give one return, at their mean
/// weighted by light; of surfaces farther apart, the brightest returns.
Hit Scanner::blend(const Hit* beams, std::size_t count) const {
  Hit best;
  double best_light = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!beams[i].found()) continue;
    double light = 0.0;
    double sum = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      if (!beams[j].found() || std::abs(beams[j].range - beams[i].range) > sensor_.pulse_m)
        continue;
      light += signal(beams[j]);
      sum += signal(beams[j]) * beams[j].range;
    }
    if (light > best_light) {
      best_light = light;
      best = beams[i];
      best.range = sum / light;
    }
  }
  return best;
}

/// Traces extra rays of a beam if neighbouring shots differ in range: it may hit both surfaces.
void Scanner::widen(const RayTracer::Moment& moment, const Aim& aim, std::size_t index,
                    std::vector<Hit>& hits) const {
  std::vector<std::size_t> edges;
  const auto differs = [&](std::size_t i, std::size_t j) {
    if (hits[i].found() != hits[j].found()) return true;
    return std::abs(hits[i].range - hits[j].range) > 0.1 + 0.02 * hits[i].range;
  };
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if ((i > 0 && differs(i, i - 1)) || (i + 1 < hits.size() && differs(i, i + 1))) {
      edges.push_back(i);
    }
  }
  std::vector<Ray> rays;
  rays.reserve(edges.size() * kExtraBeams);
  for (const std::size_t i : edges) {
    for (std::size_t k = 0; k < kExtraBeams; ++k) {
      const std::uint64_t random = word(options_, Purpose::kDivergence, index, kExtraBeams * i + k);
      Ray ray = aim.rays[i];
      ray.direction = nudged(ray.direction, sensor_.divergence * (to_unit(random) - 0.5),
                             sensor_.divergence * (to_unit(mix(random)) - 0.5));
      rays.push_back(ray);
    }
  }
  std::vector<Hit> extra(rays.size());
  moment.trace(rays, extra);
  pass_glass(moment, rays, index, 1, extra);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    std::array<Hit, kExtraBeams + 1> beams;
    beams[0] = hits[edges[e]];
    std::copy_n(extra.begin() + static_cast<std::ptrdiff_t>(kExtraBeams * e), kExtraBeams,
                beams.begin() + 1);
    hits[edges[e]] = blend(beams.data(), beams.size());
  }
}

/// A shot's point at `range`, in the frame of the sweep's points.
Vector3d Scanner::point_of(const Aim& aim, std::size_t shot, double range) const {
  const Vector3d point = aim.shots[shot].direction * range;
  if (options_.rolling != Rolling::kCorrected) return point;
  return motion_at(aim, aim.shots[shot].time_s) * point;
}

Sweep Scanner::sweep(std::size_t index) const {
  const Aim aim = this->aim(index);
  const double time = static_cast<double>(index) * sensor_.period_s;
  std::vector<double> times;
  for (std::size_t k = 0; k < aim.frames.size(); ++k) {
    const double share = static_cast<double>(k) / (kRollingSamples - 1) - 0.5;
    times.push_back(time + share * sensor_.period_s);
  }
  if (times.empty()) times.push_back(time);
  const Vector3d centre = pose_(time).translation();
  const double reach = sensor_.range_m.high;
  const RayTracer::Moment moment(tracer_, centre, world_.parts(times, time, centre, reach));
  std::vector<Hit> hits(aim.rays.size());
  moment.trace(aim.rays, hits);
  pass_glass(moment, aim.rays, index, 0, hits);
  if (!options_.noise_free && sensor_.divergence > 0.0) widen(moment, aim, index, hits);

  Sweep sweep;
  sweep.points.reserve(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    if (const auto drop = echo(hit, index, i)) {
      sweep.points.push_back(point_of(aim, i, *drop).cast<float>());
      sweep.reflectance.push_back(0.01F);
      sweep.labels.push_back(kLabelOutlier);
      continue;
    }
    if (!hit.found() || !returns(hit, word(options_, Purpose::kDrop, index, i))) continue;
    const std::uint64_t random = word(options_, Purpose::kRange, index, i);
    const double noise = options_.noise_free ? 0.0 : sensor_.noise_m * to_normal(random);
    const double shine = properties(hit.material).reflectivity * (0.4 + 0.6 * hit.cosine) *
                         (1.0 + (options_.noise_free ? 0.0 : 0.15 * to_normal(mix(random))));
    sweep.points.push_back(point_of(aim, i, hit.range + noise).cast<float>());
    // KITTI stores hundredths.
    sweep.reflectance.push_back(
        static_cast<float>(std::round(100.0 * std::clamp(shine, 0.0, 1.0)) / 100.0));
    sweep.labels.push_back(hit.label);
  }
  return sweep;
}

}  // namespace raymoval::simulated
