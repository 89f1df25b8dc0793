#include "canyon/scene/tracing/embree_device.h"

#include <embree3/rtcore.h>

#include <string>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/process/progress.h"

namespace canyon::scene::embree {

RTCDevice device() {
  static const RTCDevice instance = [] {
    RTCDevice made = rtcNewDevice(device_options().c_str());
    if (made == nullptr) {
      const RTCError error = rtcGetDeviceError(nullptr);
      if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory("there is not enough memory for a ray tracer");
      CANYON_CHECK(false, "Embree error ", static_cast<int>(error));
    }
    CANYON_CHECK(rtcGetDeviceProperty(made, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0,
                 "this Embree was built without ray masks");
    return made;
  }();
  return instance;
}

void check_no_error(const char* during) {
  const RTCError error = rtcGetDeviceError(device());
  if (error == RTC_ERROR_CANCELLED) throw Cancelled{};
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw OutOfMemory("there is not enough memory for the scene's triangles (" + std::string(during) +
                      "); a smaller scene, or larger cells of ground, need less");
  CANYON_CHECK(error == RTC_ERROR_NONE, "Embree error ", static_cast<int>(error), " during ", during);
}

void* made(void* buffer) {
  if (buffer == nullptr) check_no_error("the copying of vertices");
  CANYON_CHECK(buffer != nullptr, "Embree made no buffer");
  return buffer;
}

void build(RTCScene scene) {
  rtcSetSceneProgressMonitorFunction(
      scene, [](void*, double) { return !cancel_requested(); }, nullptr);
  // Embree's own "threads=1" would limit oneTBB in the whole process.
  run_on_one_thread([&] { rtcCommitScene(scene); });
  check_no_error("the building of the acceleration structure");
}

}  // namespace canyon::scene::embree
