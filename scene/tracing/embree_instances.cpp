#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "canyon/core/check.h"
#include "canyon/scene/surfaces/triangle.h"
#include "canyon/scene/tracing/embree_device.h"
#include "canyon/scene/tracing/instances.h"

namespace canyon::scene {

using embree::device;

namespace {

constexpr unsigned kEverything = 0xffffffffu;  // as a mask

}  // namespace

struct RigidShape::Embree {
  RTCScene scene = nullptr;
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

RigidShape::RigidShape(std::string name, ObjectKind kind, Mesh mesh)
    : name_(std::move(name)), kind_(kind), mesh_(std::move(mesh)), embree_(std::make_unique<Embree>()) {
  mesh_.object.assign(mesh_.triangles.size(), 0);
  drop_unusable_triangles(mesh_);
  embree_->scene = rtcNewScene(device());
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  if (!mesh_.triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = embree::made(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                          sizeof(Eigen::Vector3f), mesh_.vertices.size()));
    std::memcpy(vertices, mesh_.vertices.data(), mesh_.vertices.size() * sizeof(Eigen::Vector3f));
    void* indices = embree::made(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                         3 * sizeof(std::uint32_t), mesh_.triangles.size()));
    std::memcpy(indices, mesh_.triangles.data(), mesh_.triangles.size() * 3 * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree_->scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  embree::build(embree_->scene);
}

RigidShape::~RigidShape() = default;

struct InstanceSet::Embree {
  RTCScene scene = nullptr;
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

InstanceSet::InstanceSet(std::vector<Instance> instances, const Eigen::Vector3d& center_W)
    : instances_(std::move(instances)), center_W_(center_W), embree_(std::make_unique<Embree>()) {
  embree_->scene = rtcNewScene(device());
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
  first_.push_back(0);
  for (std::uint32_t i = 0; i < instances_.size(); ++i) {
    const Pose X_CS{instances_[i].X_WS.R, instances_[i].X_WS.p - center_W_};
    CANYON_CHECK(X_CS.p.allFinite() && X_CS.R.coeffs().allFinite(), "instance ", instances_[i].name);
    const Eigen::Matrix<float, 3, 4> transform = X_CS.matrix().topRows<3>().cast<float>();  // by columns
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, instances_[i].shape->embree_->scene);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree_->scene, geometry, i);
    rtcReleaseGeometry(geometry);
    first_.push_back(first_.back() + static_cast<std::uint32_t>(instances_[i].shape->mesh().triangles.size()));
  }
  embree::build(embree_->scene);
}

InstanceSet::~InstanceSet() = default;

InstanceSet::Member InstanceSet::member(std::uint32_t triangle) const {
  CANYON_CHECK(triangle < first_.back(), "triangle ", triangle, " of ", first_.back());
  const auto after = std::upper_bound(first_.begin(), first_.end(), triangle);
  const auto instance = static_cast<std::uint32_t>(after - first_.begin() - 1);
  return {instance, triangle - first_[instance]};
}

Plane InstanceSet::plane(const Member& member) const {
  const Instance& instance = instances_[member.instance];
  const Triangle in_S = Triangle::of(instance.shape->mesh(), member.triangle);
  const Pose X_CS{instance.X_WS.R, instance.X_WS.p - center_W_};
  return embree::plane_of({X_CS * in_S.a, X_CS * in_S.b, X_CS * in_S.c});
}

void InstanceSet::trace(const Ray& ray, std::uint32_t first_triangle, Hit& hit) const {
  trace(std::span<const Ray>(&ray, 1), first_triangle, std::span<Hit>(&hit, 1));
}

void InstanceSet::trace(std::span<const Ray> rays, std::uint32_t first_triangle, std::span<Hit> hits) const {
  RayPacket packet;
  for (std::size_t begin = 0; begin < rays.size(); begin += RayPacket::kRays) {
    const std::size_t count = std::min(RayPacket::kRays, rays.size() - begin);
    for (std::size_t lane = 0; lane < RayPacket::kRays; ++lane) {
      const std::size_t k = begin + std::min(lane, count - 1);
      const Eigen::Vector3f o = (rays[k].origin - center_W_).cast<float>(), d = rays[k].direction;
      packet.origin_x[lane] = o.x(), packet.origin_y[lane] = o.y(), packet.origin_z[lane] = o.z();
      packet.direction_x[lane] = d.x(), packet.direction_y[lane] = d.y(), packet.direction_z[lane] = d.z();
      packet.max_m[lane] = lane >= count ? -1.0f : hits[k].hit() ? hits[k].range_m : rays[k].max_m;
    }
    const RTCRayHit16& found = embree::trace(embree_->scene, kEverything, packet);
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (found.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
      const Member member{found.hit.instID[0][lane], found.hit.primID[lane]};
      Hit& hit = hits[begin + lane];
      hit.triangle = first_triangle + first_[member.instance] + member.triangle;
      const Ray& ray = rays[begin + lane];
      embree::refine(ray.origin - center_W_, ray.direction, plane(member), found.ray.tfar[lane], hit);
    }
  }
}

void InstanceSet::trace(std::span<const RayPacket> rays, const Eigen::Vector3d& origin_W, std::uint32_t first_triangle,
                        std::span<HitPacket> hits) const {
  const Eigen::Vector3d shift = origin_W - center_W_;
  const auto sx = static_cast<float>(shift.x()), sy = static_cast<float>(shift.y()), sz = static_cast<float>(shift.z());
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const RayPacket& r = rays[p];
    HitPacket& h = hits[p];
    RayPacket shifted = r;
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      shifted.origin_x[i] += sx, shifted.origin_y[i] += sy, shifted.origin_z[i] += sz;
      shifted.max_m[i] = std::min(h.range_m[i], r.max_m[i]);  // nothing behind what was met is looked for
    }
    const RTCRayHit16& found = embree::trace(embree_->scene, kEverything, shifted);
    for (std::size_t i = 0; i < RayPacket::kRays; ++i) {
      if (found.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const Member member{found.hit.instID[0][i], found.hit.primID[i]};
      const PlaneRange at =
          plane_range(plane(member), r.origin_x[i] + shift.x(), r.origin_y[i] + shift.y(), r.origin_z[i] + shift.z(),
                      r.direction_x[i], r.direction_y[i], r.direction_z[i], found.ray.tfar[i]);
      h.triangle[i] = first_triangle + first_[member.instance] + member.triangle;
      h.range_m[i] = at.range_m;
      h.cos_incidence[i] = static_cast<float>(std::min(std::abs(at.approach), 1.0));
    }
  }
}

bool InstanceSet::occluded(const Eigen::Vector3d& origin_W, const Eigen::Vector3f& direction, float min_m,
                           float max_m) const {
  const Eigen::Vector3f origin = (origin_W - center_W_).cast<float>();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query{};
  query.org_x = origin.x(), query.org_y = origin.y(), query.org_z = origin.z();
  query.dir_x = direction.x(), query.dir_y = direction.y(), query.dir_z = direction.z();
  query.tnear = min_m;
  query.tfar = max_m;
  query.mask = kEverything;
  rtcOccluded1(embree_->scene, &context, &query);
  return query.tfar < 0.0f;  // Embree sets -infinity
}

}  // namespace canyon::scene
