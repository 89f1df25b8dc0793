#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>

#include "canyon/core/check.h"
#include "canyon/scene/tracing/embree_device.h"

namespace canyon::scene::embree {
namespace {

struct Query {
  alignas(64) RTCRayHit16 packet;
  alignas(64) int valid[RayPacket::kRays];
  RTCIntersectContext context;

  Query() {
    std::memset(&packet, 0, sizeof packet);
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
};

}  // namespace

const RTCRayHit16& trace(RTCScene scene, std::uint32_t mask, const RayPacket& rays) {
  thread_local Query query;
  RTCRay16& r = query.packet.ray;
  CANYON_CHECK(load_lanes(rays, {r.org_x, r.org_y, r.org_z, r.dir_x, r.dir_y, r.dir_z, r.tfar, query.valid}),
               "a packet holds a ray that is not finite");
  std::fill_n(r.mask, RayPacket::kRays, mask);
  std::fill_n(query.packet.hit.geomID, RayPacket::kRays, RTC_INVALID_GEOMETRY_ID);
  std::fill_n(query.packet.hit.instID[0], RayPacket::kRays, RTC_INVALID_GEOMETRY_ID);
  rtcIntersect16(query.valid, scene, &query.context, &query.packet);
  return query.packet;
}

}  // namespace canyon::scene::embree
