// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
#include "components/sim/world.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/runtime/config/config.hpp"

namespace swiftlet {

namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Embree holds bounds and rays as floats; this covers their rounding over a kilometre.
constexpr double kBoundsMargin = 1e-4;
constexpr unsigned kPacket = 8;

void bounds_callback(const RTCBoundsFunctionArguments* args) {
  const Eigen::AlignedBox3d box = bounds(*static_cast<const Shape*>(args->geometryUserPtr));
  RTCBounds& out = *args->bounds_o;
  out.lower_x = static_cast<float>(box.min().x() - kBoundsMargin);
  out.lower_y = static_cast<float>(box.min().y() - kBoundsMargin);
  out.lower_z = static_cast<float>(box.min().z() - kBoundsMargin);
  out.upper_x = static_cast<float>(box.max().x() + kBoundsMargin);
  out.upper_y = static_cast<float>(box.max().y() + kBoundsMargin);
  out.upper_z = static_cast<float>(box.max().z() + kBoundsMargin);
}

/// Primitives are intersected with their formulas, in double precision: no tessellation.
void intersect_callback(const RTCIntersectFunctionNArguments* args) {
  const Shape& shape = *static_cast<const Shape*>(args->geometryUserPtr);
  const unsigned n = args->N;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, n);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    if (args->valid[i] != -1) continue;
    const Vector3d origin(RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i),
                          RTCRayN_org_z(rays, n, i));
    const Vector3d direction(RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i),
                             RTCRayN_dir_z(rays, n, i));
    const RayCrossing crossing =
        intersect(shape, origin, direction, RTCRayN_tnear(rays, n, i), RTCRayN_tfar(rays, n, i));
    if (crossing.t == kInfinity) continue;
    RTCRayN_tfar(rays, n, i) = static_cast<float>(crossing.t);
    RTCHitN_Ng_x(hits, n, i) = static_cast<float>(crossing.normal.x());
    RTCHitN_Ng_y(hits, n, i) = static_cast<float>(crossing.normal.y());
    RTCHitN_Ng_z(hits, n, i) = static_cast<float>(crossing.normal.z());
    RTCHitN_primID(hits, n, i) = 0;
    RTCHitN_geomID(hits, n, i) = args->geomID;
  }
}

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

}  // namespace

struct World::Impl {
  struct Entry {
    std::unique_ptr<Shape> shape;
    unsigned geometry = RTC_INVALID_GEOMETRY_ID;  // planes have none: they have no bounds
  };

  // One thread: a tree of a few hundred shapes is built in microseconds, and no thread pool starts.
  std::unique_ptr<RTCDeviceTy, Release> device{rtcNewDevice("threads=1,set_affinity=0")};
  std::unique_ptr<RTCSceneTy, Release> scene{rtcNewScene(device.get())};
  std::vector<Entry> entries;
  std::vector<const Shape*> by_geometry;  // indexed by Embree's geometry id
  std::vector<const Shape*> planes;
  std::vector<const Shape*> ground;  // planes included
  std::uint64_t revision = 0;

  void attach(Entry& entry);
  void changed();
};

void World::Impl::attach(Entry& entry) {
  const Shape& shape = *entry.shape;
  if (shape.kind == Shape::Kind::kPlane) return;
  const bool mesh = shape.kind == Shape::Kind::kMesh;
  RTCGeometry geometry =
      rtcNewGeometry(device.get(), mesh ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_USER);
  if (mesh) {
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), shape.vertices.size()));
    for (const Vector3d& vertex : shape.vertices) {
      const Eigen::Vector3f p_W = (shape.T_WS * vertex).cast<float>();
      vertices = std::copy_n(p_W.data(), 3, vertices);
    }
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), shape.triangles.size()));
    for (const auto& triangle : shape.triangles) {
      indices = std::copy_n(triangle.data(), 3, indices);
    }
  } else {
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, entry.shape.get());
    rtcSetGeometryBoundsFunction(
        geometry, [](const RTCBoundsFunctionArguments* args) { bounds_callback(args); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_callback);
  }
  rtcCommitGeometry(geometry);
  entry.geometry = rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
}

void World::Impl::changed() {
  by_geometry.clear();
  planes.clear();
  ground.clear();
  for (const Entry& entry : entries) {
    const Shape* shape = entry.shape.get();
    if (shape->kind == Shape::Kind::kPlane) planes.push_back(shape);
    if (shape->is_ground) ground.push_back(shape);
    if (entry.geometry == RTC_INVALID_GEOMETRY_ID) continue;
    if (by_geometry.size() <= entry.geometry) by_geometry.resize(entry.geometry + 1, nullptr);
    by_geometry[entry.geometry] = shape;
  }
  rtcCommitScene(scene.get());
  ++revision;
}

World::World() : impl_(std::make_unique<Impl>()) {
  impl_->changed();
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::add(Shape shape) {
  const std::string fault = fault_of(shape);
  if (!fault.empty()) throw ConfigError(fmt::format("model '{}': {}", shape.model, fault));
  if (shape.kind == Shape::Kind::kPlane) shape.is_ground = true;
  Impl::Entry entry;
  entry.shape = std::make_unique<Shape>(std::move(shape));
  impl_->attach(entry);
  impl_->entries.push_back(std::move(entry));
  impl_->changed();
}

void World::add_box(const std::string& model, const Eigen::Isometry3d& T_WS, const Vector3d& size) {
  Shape box;
  box.model = model;
  box.T_WS = T_WS;
  box.half_size = 0.5 * size;
  add(std::move(box));
}

bool World::remove(const std::string& model) {
  auto& entries = impl_->entries;
  const auto gone = std::stable_partition(entries.begin(), entries.end(), [&](const auto& entry) {
    return entry.shape->model != model;
  });
  if (gone == entries.end()) return false;
  for (auto entry = gone; entry != entries.end(); ++entry) {
    if (entry->geometry != RTC_INVALID_GEOMETRY_ID) {
      rtcDetachGeometry(impl_->scene.get(), entry->geometry);
    }
  }
  entries.erase(gone, entries.end());
  impl_->changed();
  return true;
}

std::uint64_t World::revision() const {
  return impl_->revision;
}

std::vector<const Shape*> World::shapes() const {
  std::vector<const Shape*> shapes;
  for (const Impl::Entry& entry : impl_->entries) shapes.push_back(entry.shape.get());
  return shapes;
}

void World::cast_rays(const Vector3d& origin, const Eigen::Matrix3Xd& directions, double max_range,
                      std::vector<double>& ranges) const {
  const auto count = static_cast<std::size_t>(directions.cols());
  ranges.assign(count, kInfinity);
  if (!origin.allFinite() || !(max_range > 0.0)) return;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t begin = 0; begin < count; begin += kPacket) {
    RTCRayHit8 packet{};
    alignas(32) int valid[kPacket];
    for (unsigned i = 0; i < kPacket; ++i) {
      const std::size_t beam = begin + i;
      valid[i] =
          beam < count && directions.col(static_cast<Eigen::Index>(beam)).allFinite() ? -1 : 0;
      if (valid[i] == 0) continue;
      const auto direction = directions.col(static_cast<Eigen::Index>(beam));
      packet.ray.org_x[i] = static_cast<float>(origin.x());
      packet.ray.org_y[i] = static_cast<float>(origin.y());
      packet.ray.org_z[i] = static_cast<float>(origin.z());
      packet.ray.dir_x[i] = static_cast<float>(direction.x());
      packet.ray.dir_y[i] = static_cast<float>(direction.y());
      packet.ray.dir_z[i] = static_cast<float>(direction.z());
      packet.ray.tfar[i] = static_cast<float>(max_range);
      packet.ray.mask[i] = ~0U;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, impl_->scene.get(), &context, &packet);
    for (unsigned i = 0; i < kPacket; ++i) {
      if (valid[i] == 0) continue;
      double range =
          packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? kInfinity : packet.ray.tfar[i];
      for (const Shape* plane : impl_->planes) {
        const auto direction = directions.col(static_cast<Eigen::Index>(begin + i));
        range = std::min(range, intersect(*plane, origin, direction, 0.0, max_range).t);
      }
      ranges[begin + i] = range;
    }
  }
}

std::optional<World::RayHit> World::cast_ray(const Vector3d& origin, const Vector3d& direction,
                                             double max_range) const {
  if (!origin.allFinite() || !direction.allFinite() || !(max_range > 0.0)) return std::nullopt;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(origin.x());
  query.ray.org_y = static_cast<float>(origin.y());
  query.ray.org_z = static_cast<float>(origin.z());
  query.ray.dir_x = static_cast<float>(direction.x());
  query.ray.dir_y = static_cast<float>(direction.y());
  query.ray.dir_z = static_cast<float>(direction.z());
  query.ray.tfar = static_cast<float>(max_range);
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene.get(), &context, &query);

  const Shape* shape = nullptr;
  RayCrossing best{kInfinity, Vector3d::UnitZ()};
  if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
    shape = impl_->by_geometry[query.hit.geomID];
    best = {query.ray.tfar, Vector3d(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized()};
  }
  for (const Shape* plane : impl_->planes) {
    const RayCrossing crossing = intersect(*plane, origin, direction, 0.0, max_range);
    if (crossing.t < best.t) best = crossing, shape = plane;
  }
  if (shape == nullptr) return std::nullopt;
  if (best.normal.dot(direction) > 0.0) best.normal = -best.normal;
  return RayHit{best.t, best.normal, shape->model};
}

namespace {

struct DistanceQuery {
  Vector3d point;
  const std::vector<const Shape*>* by_geometry;
  bool obstacles_only;
  World::Nearest best;
};

bool distance_callback(RTCPointQueryFunctionArguments* args) {
  auto& query = *static_cast<DistanceQuery*>(args->userPtr);
  const Shape& shape = *(*query.by_geometry)[args->geomID];
  if (query.obstacles_only && shape.is_ground) return false;
  const SurfaceDistance candidate = shape.kind == Shape::Kind::kMesh
                                        ? triangle_distance(shape, args->primID, query.point)
                                        : surface_distance(shape, query.point);
  if (!(candidate.distance < query.best.distance)) return false;
  static_cast<SurfaceDistance&>(query.best) = candidate;
  query.best.model = shape.model;
  // From now on only boxes that are nearer matter; inside of a solid, those around the point.
  args->query->radius = static_cast<float>(std::max(candidate.distance, 0.0) + kBoundsMargin);
  return true;
}

}  // namespace

std::optional<World::Nearest> World::nearest(const Vector3d& point, double max_distance,
                                             Surfaces surfaces) const {
  if (!point.allFinite() || !(max_distance >= 0.0)) return std::nullopt;
  DistanceQuery query{point, &impl_->by_geometry, surfaces == Surfaces::kObstacles, {}};
  query.best.distance = std::nextafter(max_distance, kInfinity);
  const auto consider = [&](const Shape& shape) {
    const SurfaceDistance candidate = surface_distance(shape, point);
    if (!(candidate.distance < query.best.distance)) return;
    static_cast<SurfaceDistance&>(query.best) = candidate;
    query.best.model = shape.model;
  };
  if (surfaces == Surfaces::kGround) {
    for (const Shape* shape : impl_->ground) consider(*shape);
  } else {
    if (surfaces == Surfaces::kAll) {
      for (const Shape* plane : impl_->planes) consider(*plane);
    }
    RTCPointQuery sphere{};
    sphere.x = static_cast<float>(point.x());
    sphere.y = static_cast<float>(point.y());
    sphere.z = static_cast<float>(point.z());
    sphere.radius =
        static_cast<float>(std::min(std::max(query.best.distance, 0.0) + kBoundsMargin, 1e30));
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(impl_->scene.get(), &sphere, &context, distance_callback, &query);
  }
  if (query.best.model.data() == nullptr) return std::nullopt;
  return query.best;
}

std::optional<double> World::ground_height(double x, double y) const {
  constexpr double kSky = 1e4;
  std::optional<double> height;
  for (const Shape* shape : impl_->ground) {
    const RayCrossing crossing =
        intersect(*shape, {x, y, kSky}, -Vector3d::UnitZ(), 0.0, 2.0 * kSky);
    if (crossing.t == kInfinity) continue;
    height = std::max(height.value_or(-kInfinity), kSky - crossing.t);
  }
  return height;
}

std::vector<Outline> World::slice(double height) const {
  std::vector<Outline> outlines;
  for (const Impl::Entry& entry : impl_->entries) swiftlet::slice(*entry.shape, height, outlines);
  return outlines;
}

}  // namespace swiftlet
