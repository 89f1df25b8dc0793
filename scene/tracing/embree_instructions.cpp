#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "canyon/scene/tracing/embree_device.h"
#include "canyon/scene/tracing/ray_tracer_instructions.h"

namespace canyon::scene {

namespace {

constexpr const char* kLimitVariable = "CANYON_RAY_TRACER_MAX_ISA";
constexpr std::array<const char*, 5> kSets{"sse2", "sse4.2", "avx", "avx2", "avx512"};

std::string limit() {
  const char* const value = std::getenv(kLimitVariable);
  return value == nullptr ? "" : value;
}

std::size_t rank_of(const std::string& set) {
  return static_cast<std::size_t>(std::find(kSets.begin(), kSets.end(), set) - kSets.begin());
}

/// The widest that Embree takes on this CPU: its AVX2 code also has the other instructions of that generation.
std::string of_processor() {
#if defined(__x86_64__)
  const auto all = [](auto... has) { return (... && (has != 0)); };
  const bool avx2 = all(__builtin_cpu_supports("avx2"), __builtin_cpu_supports("fma"), __builtin_cpu_supports("bmi"),
                        __builtin_cpu_supports("bmi2"));
  if (avx2 &&
      all(__builtin_cpu_supports("avx512f"), __builtin_cpu_supports("avx512dq"), __builtin_cpu_supports("avx512cd"),
          __builtin_cpu_supports("avx512bw"), __builtin_cpu_supports("avx512vl")))
    return "avx512";
  if (avx2) return "avx2";
  if (__builtin_cpu_supports("avx")) return "avx";
  if (__builtin_cpu_supports("sse4.2")) return "sse4.2";
#endif
  return "sse2";
}

}  // namespace

std::string embree::device_options() {
  return limit().empty() ? "" : "max_isa=" + limit();
}

std::string ray_tracer_instruction_set() {
  const auto has = [](RTCDeviceProperty property) { return rtcGetDeviceProperty(embree::device(), property) != 0; };
  std::size_t widest = rank_of(of_processor());
  if (!limit().empty()) widest = std::min(widest, rank_of(limit()));
  // What Embree says of itself: it may have been built without code for the widest.
  if (!has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) widest = std::min(widest, rank_of("avx2"));
  if (!has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) widest = std::min(widest, rank_of("sse4.2"));
  return kSets[std::min(widest, kSets.size() - 1)];
}

Status check_ray_tracer_limit() {
  if (limit().empty() || rank_of(limit()) < kSets.size()) return Ok{};
  return Error{kLimitVariable, 0, "", "\"" + limit() + "\"", "one of sse2, sse4.2, avx, avx2, avx512"};
}

}  // namespace canyon::scene
