// SPDX-License-Identifier: MIT
#include "datasets/simulation/world/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "datasets/simulation/shapes/random.h"
#include "datasets/simulation/shapes/shapes.h"
#include "datasets/simulation/world/world_file.h"

namespace raymoval::simulated {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTile = 96.0;  // metres

const std::string& chosen_kind(const std::vector<std::pair<std::string, double>>& kinds,
                               Random& random) {
  double sum = 0.0;
  for (const auto& [kind, weight] : kinds) sum += weight;
  double pick = random.unit() * sum;
  for (const auto& [kind, weight] : kinds) {
    pick -= weight;
    if (pick < 0.0) return kind;
  }
  return kinds.back().first;
}

/// A steady `speed`, or with the pauses of the flow.
SpeedProfile paced(const FlowSpec& flow, double speed, double duration, Random random) {
  if (!(flow.stop_every_s.high > 0.0)) return SpeedProfile({{0.0, speed}});
  constexpr double kRamp = 0.5;  // seconds from standing to walking
  std::vector<std::pair<double, double>> knots;
  // A random time in the first interval, so that not all stop together.
  double time = -random.unit() * flow.stop_every_s.high;
  while (time < duration) {
    knots.emplace_back(time, speed);
    time += random.between(flow.stop_every_s.low, flow.stop_every_s.high);
    knots.emplace_back(time, speed);
    knots.emplace_back(time += kRamp, 0.0);
    knots.emplace_back(time += kRamp + random.between(flow.stop_for_s.low, flow.stop_for_s.high),
                       0.0);
    time += kRamp;
  }
  return SpeedProfile(std::move(knots));
}

bool keeps_lane(const std::string& kind) {
  return kind != "pedestrian" && kind != "cyclist";
}

}  // namespace

World::World(const WorldFile& file, std::uint64_t seed, double duration)
    : ground_(std::make_unique<Ground>(file.terrain, file.roads, file.seed)) {
  for (const Ground::Piece& piece : ground_->pieces()) {
    add_static(piece.mesh, Isometry3d(Eigen::Translation3d(piece.origin)));
  }
  std::uint64_t number = 0;
  for (const RowSpec& row : file.rows) add_row(row, file.seed, ++number);
  for (const PlaceSpec& place : file.places) add_place(place, file.seed, ++number);
  for (const MoverSpec& mover : file.movers) add_movers(mover, seed, ++number);
  for (const FlowSpec& flow : file.flows) add_flow(flow, seed, ++number, duration);
  for (const QueueSpec& queue : file.queues) add_queue(queue, seed, ++number);
  air_ = file.air;
  for (const auto& mover : movers_) mover->set_label(duration);
  ego_.emplace(file.ego, *ground_);
  finish();
}

std::uint16_t World::next_instance() {
  if (instances_ == 0xFFF0) throw ConfigurationError("a world has at most 65,519 objects.");
  return ++instances_;
}

void World::add_static(const Mesh& mesh, const Isometry3d& T_world_mesh) {
  const Vector3d at = T_world_mesh.translation();
  const Vector3d origin(std::floor(at.x() / kTile) * kTile, std::floor(at.y() / kTile) * kTile, 0);
  auto tile =
      std::find_if(tiles_.begin(), tiles_.end(), [&](const Tile& t) { return t.origin == origin; });
  if (tile == tiles_.end()) {
    tile = tiles_.emplace(tiles_.end());
    tile->origin = origin;
  }
  Isometry3d T_tile_mesh = T_world_mesh;
  T_tile_mesh.translation() -= origin;
  tile->mesh.append(mesh, T_tile_mesh);
}

void World::finish() {
  for (Tile& tile : tiles_) {
    Eigen::AlignedBox3f box;
    for (const auto& v : tile.mesh.vertices) box.extend(v);
    tile.low = box.min().cast<double>() + tile.origin;
    tile.high = box.max().cast<double>() + tile.origin;
  }
}

void World::add_row(const RowSpec& row, std::uint64_t seed, std::uint64_t number) {
  const Road& road = ground_->road(row.road);
  const double end = row.to_m < 0.0 ? road.path.length() : std::min(row.to_m, road.path.length());
  for (const bool left : {true, false}) {
    if (!(left ? row.left : row.right)) continue;
    std::uint64_t place = 0;
    double spacing = 0.0;
    for (double s = row.from_m; s < end; s += spacing) {
      Random random(seed, Purpose::kPart, number, ++place * 2 + (left ? 1 : 0));
      spacing = random.between(row.spacing_m.low, row.spacing_m.high);
      if (!random.chance(row.share)) continue;
      PartSpec part = row.part;
      const bool continuous = is_continuous(part.part);
      if (continuous || part.part == "tall_grass") part.length_m = spacing;
      const double offset = random.between(row.offset_m.low, row.offset_m.high);
      const double side = left ? 1.0 : -1.0;
      // A continuous part runs in +x of its own frame: on the right side, back along the road.
      const double at_s = continuous ? (left ? s : s + spacing) : s + 0.5 * spacing;
      const Vector2d at = road.path.at(at_s, side * offset);
      const Vector2d middle = road.path.at(s + 0.5 * spacing, side * offset);
      if (ground_->clearance(middle, &road) < footprint_radius(part)) continue;
      const Vector2d along = side * road.path.direction(s + 0.5 * spacing);
      const double yaw = std::atan2(along.y(), along.x()) + row.turn_rad;
      if (row.presence.is_limited()) {
        const Vector2d ahead(std::cos(yaw), std::sin(yaw));
        add_parked(part.part.substr(std::string("parked_").size()), row.presence, at, ahead,
                   random);
        continue;
      }
      const std::uint16_t instance = has_instance(part.part) ? next_instance() : 0;
      add_static(make_part(part, instance, random),
                 placed(at.x(), at.y(), ground_->height(at) + part.above_m, yaw));
    }
  }
}

void World::add_place(const PlaceSpec& place, std::uint64_t seed, std::uint64_t number) {
  Random random(seed, Purpose::kPart, number);
  const std::uint16_t instance = has_instance(place.part.part) ? next_instance() : 0;
  add_static(make_part(place.part, instance, random),
             placed(place.at.x(), place.at.y(), ground_->height(place.at) + place.part.above_m,
                    place.yaw_rad));
}

void World::add_movers(const MoverSpec& spec, std::uint64_t seed, std::uint64_t number) {
  for (int i = 0; i < spec.group; ++i) {
    Random random(seed, Purpose::kMover, number, static_cast<std::uint64_t>(i));
    Route route = spec.route;
    const int row = i / 3, column = (i + 1) / 2;
    if (i > 0) route.start_m += random.between(-0.4, 0.4) - 0.7 * row;
    const double left = 0.75 * column * (i % 2 == 0 ? 1.0 : -1.0) * (i == 0 ? 0.0 : 1.0);
    add_mover(Mover(spec.kind, make_body(spec.kind, random), Track(route, *ground_), left,
                    next_instance(), spec.presence));
  }
}

/// Adds a vehicle that is stationary at `at` during its presence.
void World::add_parked(const std::string& kind, const Presence& presence, const Vector2d& at,
                       const Vector2d& along, Random& random) {
  Route route;
  route.points = {at - along, at + along};
  route.start_m = 1.0;
  if (random.chance(0.5)) std::swap(route.points[0], route.points[1]);
  Body body = make_body(kind, random);
  add_mover(Mover(kind, std::move(body), Track(route, *ground_), 0.0, next_instance(), presence));
}

void World::add_queue(const QueueSpec& queue, std::uint64_t seed, std::uint64_t number) {
  for (std::size_t lane = 0; lane < queue.lanes_m.size(); ++lane) {
    Random random(seed, Purpose::kQueue, number, lane);
    std::vector<std::string> kinds;
    std::vector<Body> bodies;
    std::vector<double> lengths;
    for (int i = 0; i < queue.count; ++i) {
      kinds.push_back(chosen_kind(queue.kinds, random));
      bodies.push_back(make_body(kinds.back(), random));
      lengths.push_back(bodies.back().length_m);
    }
    const std::vector<QueuePlace> places = queue_places(queue, lengths, random);
    for (std::size_t i = 0; i < places.size(); ++i) {
      Route route;
      route.road = queue.road;
      route.reverse = queue.reverse;
      route.lane_m = queue.lanes_m[lane];
      route.start_m = places[i].start_m;
      route.speed = places[i].speed;
      add_mover(Mover(kinds[i], std::move(bodies[i]), Track(route, *ground_), places[i].left_m,
                      next_instance()));
    }
  }
}

void World::add_flow(const FlowSpec& flow, std::uint64_t seed, std::uint64_t number,
                     double duration) {
  Route route = flow.route;
  const Track whole(route, *ground_);
  const double mean = 0.5 * (flow.speed_mps.low + flow.speed_mps.high);
  // Movers that enter during the sequence start before the beginning of an open route.
  const double end = flow.to_m < 0.0 ? whole.length() : flow.to_m;
  const double fed = whole.closed() ? 0.0 : -flow.speed_mps.high * duration;
  const double begin = flow.from_m.value_or(fed);
  std::uint64_t place = 0;
  for (double s = end; s > begin;) {
    Random random(seed, Purpose::kFlow, number, ++place);
    const std::string kind = chosen_kind(flow.kinds, random);
    const bool lane = keeps_lane(kind);
    const double speed = lane ? mean : random.between(flow.speed_mps.low, flow.speed_mps.high);
    const int members = 1 + (lane ? 0 : random.below(flow.group));
    for (int i = 0; i < members; ++i) {
      route.start_m = s + (i == 0 ? 0.0 : random.between(-0.5, 0.5));
      route.speed =
          lane ? SpeedProfile({{0.0, speed}})
               : paced(flow, speed, duration,
                       Random(seed, Purpose::kPause, number, place * 64 + std::uint64_t(i)));
      const double left = lane ? random.between(-0.2, 0.2) : random.between(-0.2, 0.2) - 0.7 * i;
      Body body = make_body(kind, random);
      s -= i == 0 ? body.length_m : 0.0;
      add_mover(Mover(kind, std::move(body), Track(route, *ground_), left, next_instance()));
    }
    s -= random.between(flow.gap_m.low, flow.gap_m.high);
  }
}

std::vector<std::vector<PlacedPart>> World::parts(const std::vector<double>& times,
                                                  double reference, const Vector3d& around,
                                                  double reach) const {
  std::vector<std::vector<PlacedPart>> samples(times.size());
  for (const auto& mover : movers_) {
    if (!mover->present(reference)) continue;
    const double room = reach + mover->body().length_m;
    if ((mover->pose(reference).translation() - around).norm() > room) continue;
    for (std::size_t i = 0; i < times.size(); ++i) mover->place(times[i], samples[i]);
  }
  for (std::size_t i = 0; i < times.size() && ego_; ++i) ego_->place(times[i], samples[i]);
  return samples;
}

}  // namespace raymoval::simulated
