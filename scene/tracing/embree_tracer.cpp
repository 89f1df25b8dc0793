#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/scene/surfaces/triangle.h"
#include "canyon/scene/tracing/embree_device.h"
#include "canyon/scene/tracing/plane_ranges.h"
#include "canyon/scene/tracing/tracer.h"

namespace canyon::scene {
namespace {

using embree::device;

constexpr std::size_t kPacket = RayPacket::kRays;

}  // namespace

struct Tracer::Embree {
  Embree(const Mesh& the_mesh, const Eigen::Vector3d& center) : mesh(the_mesh), center_W(center) {}
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }

  const Mesh& mesh;
  Eigen::Vector3d center_W;
  RTCScene scene = nullptr;
  /// Terrain, solids and trees are separate geometries, told apart by their masks; here: their triangles' indices in
  /// the mesh.
  std::array<std::vector<std::uint32_t>, 3> members;

  /// The vertices that are in use, about the center (exactly), and where each of the mesh's went.
  struct Vertices {
    RTCBuffer buffer;
    std::size_t count = 0;
    std::vector<std::uint32_t> place;
  };
  Vertices vertices_in_use() const {
    Vertices out;
    out.place.assign(mesh.vertices.size(), Hit::kMiss);
    for (const auto& geometry : members)
      for (const std::uint32_t i : geometry)
        for (const std::uint32_t v : mesh.triangles[i]) out.place[v] = 0;
    for (std::uint32_t& place : out.place)
      if (place == 0) place = static_cast<std::uint32_t>(out.count++);
    // Embree reads each vertex as four floats, so one float beyond the last must be readable.
    out.buffer = rtcNewBuffer(device(), out.count * sizeof(Eigen::Vector3f) + 16);
    embree::made(out.buffer);
    auto* p = static_cast<Eigen::Vector3f*>(rtcGetBufferData(out.buffer));
    for (std::size_t v = 0; v < out.place.size(); ++v)
      if (out.place[v] != Hit::kMiss) *p++ = (mesh.vertices[v].cast<double>() - center_W).cast<float>();
    return out;
  }

  void add_geometry(unsigned geometry_id, const Vertices& vertices) {
    const std::vector<std::uint32_t>& triangles = members[geometry_id];
    if (triangles.empty()) return;
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.buffer, 0,
                         sizeof(Eigen::Vector3f), vertices.count);
    auto* index = static_cast<std::uint32_t*>(embree::made(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size())));
    for (const std::uint32_t i : triangles)
      for (const std::uint32_t v : mesh.triangles[i]) *index++ = vertices.place[v];
    rtcSetGeometryMask(geometry, 1u << geometry_id);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, geometry_id);
    rtcReleaseGeometry(geometry);
  }

  std::uint32_t triangle(unsigned geometry_id, unsigned primitive_id) const {
    return members[geometry_id][primitive_id];
  }

  /// About the center, as rays are traced.
  Plane plane(std::uint32_t index) const {
    const Triangle t = Triangle::of(mesh, index);
    return embree::plane_of({t.a - center_W, t.b - center_W, t.c - center_W});
  }
  Eigen::Vector3d local(const Eigen::Vector3d& p_W) const { return p_W - center_W; }

  /// Embree's ray.
  RTCRay ray(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, const RaySpan& span,
             std::uint32_t mask) const {
    const Eigen::Vector3f p = (local(origin_W) + span.start_m * direction.cast<double>()).cast<float>();
    RTCRay out{};
    out.org_x = p.x(), out.org_y = p.y(), out.org_z = p.z();
    out.dir_x = direction.x(), out.dir_y = direction.y(), out.dir_z = direction.z();
    out.tnear = static_cast<float>(span.from_m - span.start_m);
    out.tfar = static_cast<float>(span.to_m - span.start_m);
    out.mask = mask;
    return out;
  }

  /// What packets need of the triangles: 40 bytes each, made when the first packet is traced, so that scenes whose
  /// sensors send none do not pay.
  PlaneTable planes() const {
    std::call_once(rows_once, [this] {
      std::size_t count = 1;
      for (const auto& geometry : members) count += geometry.size();
      rows.reserve(count);
      for (std::size_t id = 0; id < members.size(); ++id) {
        first[id] = static_cast<std::uint32_t>(rows.size());
        for (const std::uint32_t index : members[id]) rows.push_back({plane(index), index});
      }
      rows.push_back({{}, Hit::kMiss});
    });
    return {rows.data(), first, static_cast<std::uint32_t>(rows.size() - 1)};
  }
  mutable std::once_flag rows_once;
  mutable std::array<std::uint32_t, 3> first{};
  mutable std::vector<PlaneRow> rows;

  /// The hit in double precision, from the plane of the triangle that Embree found.
  Hit hit(const Ray& ray, unsigned geometry_id, unsigned primitive_id, float embree_range_m) const {
    Hit result;
    if (geometry_id == RTC_INVALID_GEOMETRY_ID) return result;
    result.triangle = triangle(geometry_id, primitive_id);
    embree::refine(local(ray.origin), ray.direction, plane(result.triangle), embree_range_m, result);
    return result;
  }
};

Tracer::Tracer(const SceneParts& parts, std::span<const std::uint32_t> triangles, const Eigen::Vector3d& center_W)
    : embree_(std::make_unique<Embree>(parts.mesh, center_W)) {
  for (const std::uint32_t i : triangles) {
    const ObjectKind kind = parts.objects[parts.mesh.object[i]].kind;
    embree_->members[kind == ObjectKind::kTerrain ? 0 : kind == ObjectKind::kTree ? 2 : 1].push_back(i);
  }
  embree_->scene = rtcNewScene(device());
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  const Embree::Vertices vertices = embree_->vertices_in_use();
  for (unsigned id = 0; id < 3; ++id) embree_->add_geometry(id, vertices);
  rtcReleaseBuffer(vertices.buffer);
  embree::build(embree_->scene);
}

Tracer::~Tracer() = default;

Hit Tracer::trace(const Ray& ray, const RaySpan& span) const {
  embree::check_finite(ray);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = embree_->ray(ray.origin, ray.direction, span, kTraceAll);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  const float range_m = query.ray.tfar + static_cast<float>(span.start_m);
  return embree_->hit(ray, query.hit.geomID, query.hit.primID, range_m);
}

void Tracer::trace(std::span<const Ray> rays, std::span<Hit> hits) const {
  CANYON_CHECK(rays.size() == hits.size(), "rays = ", rays.size(), ", hits = ", hits.size());
  RayPacket packet;
  for (std::size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const std::size_t count = std::min(kPacket, rays.size() - begin);
    for (std::size_t lane = 0; lane < kPacket; ++lane) {
      const Ray& ray = rays[begin + std::min(lane, count - 1)];
      embree::check_finite(ray);
      const Eigen::Vector3f origin = embree_->local(ray.origin).cast<float>();
      packet.origin_x[lane] = origin.x(), packet.origin_y[lane] = origin.y(), packet.origin_z[lane] = origin.z();
      packet.direction_x[lane] = ray.direction.x(), packet.direction_y[lane] = ray.direction.y();
      packet.direction_z[lane] = ray.direction.z();
      packet.max_m[lane] = lane < count ? ray.max_m : -1.0f;
    }
    const RTCRayHit16& found = embree::trace(embree_->scene, kTraceAll, packet);
    for (std::size_t lane = 0; lane < count; ++lane) {
      hits[begin + lane] =
          embree_->hit(rays[begin + lane], found.hit.geomID[lane], found.hit.primID[lane], found.ray.tfar[lane]);
    }
  }
}

void Tracer::trace(std::span<const RayPacket> rays, std::span<HitPacket> hits) const {
  CANYON_CHECK(rays.size() == hits.size(), "packets of rays = ", rays.size(), ", of hits = ", hits.size());
  const PlaneTable table = embree_->planes();
  HeldPlanes held;
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const RTCRayHit16& found = embree::trace(embree_->scene, kTraceAll, rays[p]);
    hits_of({found.hit.geomID, found.hit.primID, found.ray.tfar}, table, rays[p], held, hits[p]);
  }
}

bool Tracer::occluded(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, const RaySpan& span,
                      std::uint32_t mask) const {
  CANYON_CHECK((origin_W.array().abs() <= kFarthest_m).all() && (direction.array().abs() <= kFarthest_m).all(),
               "origin ", origin_W.transpose(), " direction ", direction.transpose());
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = embree_->ray(origin_W, direction, span, mask);
  rtcOccluded1(embree_->scene, &context, &query);
  return query.tfar < 0.0f;  // Embree sets -infinity
}

std::uint32_t Tracer::terrain_triangle(double x, double y) const {
  if (embree_->members[0].empty() || !(std::abs(x) <= kFarthest_m) || !(std::abs(y) <= kFarthest_m)) return Hit::kMiss;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  const Eigen::Vector3f p = embree_->local({x, y, 0.0}).cast<float>();
  query.ray.org_x = p.x(), query.ray.org_y = p.y(), query.ray.org_z = 1e4f;
  query.ray.dir_z = -1.0f;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = kTraceTerrain;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene, &context, &query);
  return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? Hit::kMiss : embree_->members[0][query.hit.primID];
}

namespace {

struct NearestQuery {
  const Mesh* mesh;
  const std::array<std::vector<std::uint32_t>, 3>* members;
  Eigen::Vector3d p_W;
  double slack_m;
  NearestSurface best;
};

bool visit_candidate(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<NearestQuery*>(arguments->userPtr);
  const std::uint32_t index = (*query.members)[arguments->geomID][arguments->primID];
  const Eigen::Vector3d point = Triangle::of(*query.mesh, index).closest_point(query.p_W);
  const double distance_m = (point - query.p_W).norm();
  // Equal distances (a common edge): the lower index, whatever the order of visits.
  const bool nearer =
      distance_m < query.best.distance_m || (distance_m == query.best.distance_m && index < query.best.triangle);
  if (!nearer) return false;
  query.best = {distance_m, point, index};
  const float radius = static_cast<float>(distance_m + query.slack_m);
  if (radius >= arguments->query->radius) return false;
  arguments->query->radius = radius;
  return true;
}

}  // namespace

NearestSurface Tracer::nearest(const Eigen::Vector3d& p_W, double max_m) const {
  CANYON_CHECK(p_W.allFinite() && max_m >= 0.0, "p = ", p_W.transpose(), ", max_m = ", max_m);
  // The tree is searched around the point rounded to single precision; the slack covers that rounding.
  const Eigen::Vector3d p = embree_->local(p_W);
  const double slack_m = 1e-6 * (1.0 + p.cwiseAbs().maxCoeff() + std::min(max_m, 1e6));
  NearestQuery search{&embree_->mesh, &embree_->members, p_W, slack_m, {}};
  search.best.distance_m = max_m;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{};
  query.x = static_cast<float>(p.x()), query.y = static_cast<float>(p.y()), query.z = static_cast<float>(p.z());
  query.radius = static_cast<float>(std::min(max_m, 1e6) + slack_m);
  rtcPointQuery(embree_->scene, &query, &context, visit_candidate, &search);
  return search.best.triangle == Hit::kMiss ? NearestSurface{} : search.best;
}

}  // namespace canyon::scene
