#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "canyon/core/check.h"
#include "canyon/scene/farthest.h"
#include "canyon/scene/scene_at.h"
#include "canyon/scene/surfaces/triangle.h"
#include "canyon/scene/tracing/plane_ranges.h"

struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCRayHit16;

/// What the files that know Embree (embree_*.cpp) share.
namespace canyon::scene::embree {

/// One device for the whole process.
RTCDeviceTy* device();
/// What it is made with: the limit of ray_tracer_instructions.h, in Embree's words.
std::string device_options();
/// Throws if Embree has reported an error since the last call: Cancelled where the user asked to stop, OutOfMemory, a
/// failed check for all else.
void check_no_error(const char* during);
/// A buffer that Embree has made; throws where it could not.
void* made(void* buffer);
/// Builds the tree of a scene on the calling thread: the order in which a parallel build places triangles in the tree
/// may vary, and with it which of two triangles a ray through their common edge meets. Throws Cancelled within a tenth
/// of a second after the user asked to stop.
void build(RTCSceneTy* scene);

/// The computation could not finish: the machine has too little memory for the scene.
struct OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a packet's rays meet first of the geometries that `mask` names, as Embree lays it out; valid until the calling
/// thread's next call. Lanes that are not traced meet nothing. Throws where a ray is not finite.
const RTCRayHit16& trace(RTCSceneTy* scene, std::uint32_t mask, const RayPacket& rays);

/// Throws unless the ray's numbers are finite, and within what Embree takes.
inline void check_finite(const Ray& ray) {
  CANYON_CHECK((ray.origin.array().abs() <= kFarthest_m).all() && (ray.direction.array().abs() <= kFarthest_m).all() &&
                   !std::isnan(ray.max_m),
               "origin ", ray.origin.transpose(), " direction ", ray.direction.transpose());
}

inline Plane plane_of(const Triangle& t) {
  const Eigen::Vector3d n = t.area_normal().normalized();
  return {n.x(), n.y(), n.z(), n.x() * t.a.x() + n.y() * t.a.y() + n.z() * t.a.z()};
}

/// Range and normal of a hit in double precision, from the plane of the triangle that Embree found at `traced_m`. Plane
/// and origin are in the same frame.
inline void refine(const Eigen::Vector3d& o, const Eigen::Vector3f& direction, const Plane& plane, float traced_m,
                   Hit& hit) {
  const Eigen::Vector3d d = direction.cast<double>();
  const PlaneRange found = plane_range(plane, o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), traced_m);
  hit.range_m = found.range_m;
  const double towards = found.approach > 0.0 ? -1.0 : 1.0;
  hit.normal = (towards * Eigen::Vector3d(plane.x, plane.y, plane.z)).cast<float>();
}

}  // namespace canyon::scene::embree
