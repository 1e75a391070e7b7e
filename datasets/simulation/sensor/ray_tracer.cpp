// SPDX-License-Identifier: MIT
#include "datasets/simulation/sensor/ray_tracer.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <string>
#include <unordered_map>

#include "core/error.h"
#include "core/parallel.h"

// One set of names for Embree 3 and 4. CMake defines the version that it found.
#if RAYMOVAL_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace raymoval::simulated {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

#if RAYMOVAL_EMBREE >= 4
using TraceOptions = RTCIntersectArguments;
#else
using TraceOptions = RTCIntersectContext;
#endif

/// @return Embree's options for packets of rays that start close to each other
TraceOptions coherent_rays() {
  TraceOptions options;
#if RAYMOVAL_EMBREE >= 4
  rtcInitIntersectArguments(&options);
  options.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
  rtcInitIntersectContext(&options);
  options.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  return options;
}

/// Finds the first hits of eight rays.
/// @param valid -1 for each valid ray, else 0
void trace_eight(const int* valid, RTCScene scene, TraceOptions& options, RTCRayHit8& packet) {
#if RAYMOVAL_EMBREE >= 4
  rtcIntersect8(valid, scene, &packet, &options);
#else
  rtcIntersect8(valid, scene, &options, &packet);
#endif
}

constexpr std::size_t kPacket = 8;
constexpr double kNearest = 0.01;  // metres; no surface is nearer to a sensor

/// Checks for errors since the last check; after an error, Embree continues with a part of the
/// scene.
/// @throws std::bad_alloc if the ray tracer got no memory, InternalError for other errors
/// @param device null for the error of creating a device
void check_tracer(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throw InternalError("the ray tracer (Embree) failed with its error " +
                      std::to_string(static_cast<int>(error)) + ".");
}

/// The same, for a call that has certainly failed.
[[noreturn]] void fail(RTCDevice device, const char* what) {
  check_tracer(device);
  throw InternalError(std::string("the ray tracer (Embree) cannot ") + what + ".");
}

/// Builds the search tree on the calling thread only: the result is deterministic, and scans are
/// traced in parallel. (Embree's option for one thread would affect the whole process.)
void commit(RTCScene scene) {
  tbb::task_arena alone(1, 1);
  alone.execute([&] { rtcCommitScene(scene); });
}

/// A committed scene of one mesh. Buffers are shared with the mesh, which must outlive it.
RTCScene build_scene(RTCDevice device, const Mesh& mesh) {
  const RTCScene scene = rtcNewScene(device);
  if (scene == nullptr) fail(device, "make a scene");
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  if (!mesh.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree reads whole 16-byte words: copying adds the padding that a vector lacks.
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    auto* triangles = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (vertices == nullptr || triangles == nullptr) fail(device, "get memory for a mesh");
    for (const auto& v : mesh.vertices) vertices = std::copy(v.data(), v.data() + 3, vertices);
    for (const auto& t : mesh.triangles) triangles = std::copy(t.begin(), t.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  commit(scene);
  check_tracer(device);
  return scene;
}

/// Embree's result for one ray.
struct Found {
  bool any;
  unsigned instance;
  unsigned triangle;
  float range;
};

void enter(RTCRayHit8& packet, std::size_t k, const Ray& ray, double reach) {
  packet.ray.org_x[k] = static_cast<float>(ray.origin.x());
  packet.ray.org_y[k] = static_cast<float>(ray.origin.y());
  packet.ray.org_z[k] = static_cast<float>(ray.origin.z());
  packet.ray.dir_x[k] = static_cast<float>(ray.direction.x());
  packet.ray.dir_y[k] = static_cast<float>(ray.direction.y());
  packet.ray.dir_z[k] = static_cast<float>(ray.direction.z());
  packet.ray.tnear[k] = static_cast<float>(kNearest);
  packet.ray.tfar[k] = static_cast<float>(reach);
  packet.ray.time[k] = ray.time;
  packet.ray.mask[k] = ~0U;
  packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
}

std::array<float, 12> column_major(const Isometry3d& motion) {
  std::array<float, 12> values;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) {
      values[static_cast<std::size_t>(3 * c + r)] = static_cast<float>(motion(r, c));
    }
  }
  return values;
}

}  // namespace

struct RayTracer::State {
  const World* world = nullptr;
  double reach = 0.0;
  RTCDevice device = nullptr;
  std::vector<RTCScene> tiles;
  std::unordered_map<const Mesh*, RTCScene> parts;

  void add_part(const Mesh& mesh) {
    if (!parts.contains(&mesh)) parts.emplace(&mesh, build_scene(device, mesh));
  }
  ~State() {
    for (const RTCScene scene : tiles) rtcReleaseScene(scene);
    for (const auto& [mesh, scene] : parts) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayTracer::RayTracer(const World& world, double reach, int threads)
    : state_(std::make_unique<State>()) {
  state_->world = &world;
  state_->reach = reach;
  state_->device = rtcNewDevice("set_affinity=0");
  if (state_->device == nullptr) fail(nullptr, "start");
  state_->tiles.resize(world.tiles().size(), nullptr);
  parallel_for(threads, world.tiles().size(), 1, [&](std::size_t i) {
    state_->tiles[i] = build_scene(state_->device, world.tiles()[i].mesh);
  });
  for (const auto& mover : world.movers()) {
    for (const BodyPart& part : mover->body().parts) state_->add_part(part.mesh);
  }
  if (world.ego()) {
    std::vector<PlacedPart> parts;
    world.ego()->place(0.0, parts);
    for (const PlacedPart& part : parts) state_->add_part(*part.mesh);
  }
}

RayTracer::~RayTracer() = default;

struct RayTracer::Moment::State {
  /// An instance of the scene.
  struct Instance {
    const Mesh* mesh;
    Isometry3d motion;  ///< From the mesh to the moment's frame.
    std::uint32_t label;
    bool moves;  ///< Within the moment.
  };
  RTCScene scene = nullptr;
  std::vector<Instance> instances;
  double reach = 0.0;

  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
  void add(RTCDevice device, RTCScene what, const std::vector<Isometry3d>& motions,
           const Mesh& mesh, std::uint32_t label);
  [[nodiscard]] Hit examine(const Ray& ray, const Found& found) const;
};

void RayTracer::Moment::State::add(RTCDevice device, RTCScene what,
                                   const std::vector<Isometry3d>& motions, const Mesh& mesh,
                                   std::uint32_t label) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, what);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(motions.size()));
  for (std::size_t i = 0; i < motions.size(); ++i) {
    rtcSetGeometryTransform(geometry, static_cast<unsigned>(i), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                            column_major(motions[i]).data());
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(instances.size()));
  rtcReleaseGeometry(geometry);
  instances.push_back({&mesh, motions.front(), label, motions.size() > 1});
}

Hit RayTracer::Moment::State::examine(const Ray& ray, const Found& found) const {
  Hit hit;
  if (!found.any) return hit;
  const Instance& instance = instances[found.instance];
  const auto& triangle = instance.mesh->triangles[found.triangle];
  const Paint& paint = instance.mesh->paints[found.triangle];
  hit.material = paint.material;
  hit.label = instance.label != 0 ? instance.label : paint.label;
  hit.range = static_cast<double>(found.range);
  const auto corner = [&](int i) {
    return Vector3d(instance.mesh->vertices[triangle[static_cast<std::size_t>(i)]].cast<double>());
  };
  const Vector3d a = corner(0);
  const Vector3d normal = (corner(1) - a).cross(corner(2) - a);
  const auto turn = instance.motion.linear();
  const Vector3d direction = turn.transpose() * ray.direction;
  const double against = normal.dot(direction);
  hit.cosine = std::min(1.0, std::abs(against) / std::max(1e-30, normal.norm()));
  if (instance.moves) return hit;  // Embree has moved the part to the ray's own time
  const Vector3d origin = turn.transpose() * (ray.origin - instance.motion.translation());
  const double exact = normal.dot(a - origin) / against;
  // A ray that only grazes its triangle has no better range than the tracer's.
  if (std::abs(exact - hit.range) < 0.01) hit.range = exact;
  return hit;
}

RayTracer::Moment::Moment(const RayTracer& tracer, const Vector3d& centre,
                          std::vector<std::vector<PlacedPart>> samples)
    : state_(std::make_unique<State>()) {
  const RayTracer::State& world = *tracer.state_;
  state_->reach = world.reach;
  state_->scene = rtcNewScene(world.device);
  if (state_->scene == nullptr) fail(world.device, "make a scene");
  rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  const auto& tiles = world.world->tiles();
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const Vector3d nearest = centre.cwiseMax(tiles[i].low).cwiseMin(tiles[i].high);
    if ((nearest - centre).norm() > world.reach) continue;
    const Isometry3d motion(Eigen::Translation3d(tiles[i].origin - centre));
    state_->add(world.device, world.tiles[i], {motion}, tiles[i].mesh, 0);
  }
  for (std::size_t p = 0; p < samples.front().size(); ++p) {
    std::vector<Isometry3d> motions;
    for (const auto& sample : samples) {
      motions.push_back(sample[p].T_world_part);
      motions.back().translation() -= centre;
    }
    const PlacedPart& part = samples.front()[p];
    const auto scene = world.parts.find(part.mesh);
    if (scene == world.parts.end()) fail(world.device, "place a part that is not of its world");
    state_->add(world.device, scene->second, motions, *part.mesh, part.label);
  }
  commit(state_->scene);
  check_tracer(world.device);
}

RayTracer::Moment::~Moment() = default;

void RayTracer::Moment::trace(std::span<const Ray> rays, std::span<Hit> hits) const {
  TraceOptions options = coherent_rays();
  // Neighbouring shots walk the search tree together.
  for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - begin);
    alignas(32) std::array<int, kPacket> valid{};
    alignas(32) RTCRayHit8 packet{};
    for (std::size_t k = 0; k < count; ++k) {
      valid[k] = -1;
      enter(packet, k, rays[begin + k], state_->reach);
    }
    trace_eight(valid.data(), state_->scene, options, packet);
    for (std::size_t k = 0; k < count; ++k) {
      const Found found{packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID, packet.hit.instID[0][k],
                        packet.hit.primID[k], packet.ray.tfar[k]};
      hits[begin + k] = state_->examine(rays[begin + k], found);
    }
  }
}

}  // namespace raymoval::simulated
