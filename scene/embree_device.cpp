#include "scene/embree_device.h"

#include <embree3/rtcore.h>

#include "core/check.h"
#include "core/parallel.h"

namespace canyon::scene::embree {

RTCDevice device() {
  static const RTCDevice instance = [] {
    RTCDevice made = rtcNewDevice(device_options().c_str());
    CANYON_CHECK(made != nullptr, "Embree error ", static_cast<int>(rtcGetDeviceError(nullptr)));
    CANYON_CHECK(rtcGetDeviceProperty(made, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0,
                 "this Embree was built without ray masks");
    return made;
  }();
  return instance;
}

void check_no_error(const char* during) {
  const RTCError error = rtcGetDeviceError(device());
  CANYON_CHECK(error == RTC_ERROR_NONE, "Embree error ", static_cast<int>(error), " during ", during);
}

void build(RTCScene scene) {
  // Embree's own "threads=1" would limit oneTBB in the whole process.
  run_on_one_thread([&] { rtcCommitScene(scene); });
  check_no_error("the building of the acceleration structure");
}

}  // namespace canyon::scene::embree
