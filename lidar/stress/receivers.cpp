// Detectors and the choice of returns: no signal, the threshold, saturation, equals, more echoes than fit.
#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/config/config.h"
#include "canyon/core/output/printed.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/echoes.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/receiver/detector.h"
#include "canyon/lidar/receiver/return_choice.h"
#include "canyon/lidar/stress/subjects.h"

namespace canyon::lidar {
namespace {

using stress::kHalfUlp;
constexpr float kNone = std::numeric_limits<float>::infinity();

LidarConfig with_keys(const std::string& keys) {
  LidarConfig config;
  const auto node = ConfigNode::parse(keys, "keys");
  CANYON_CHECK(node.ok() && read_config(&*node, "lidar", config).ok(), keys);
  return config;
}

/// What a detector makes of 3200 alike echoes.
struct Detected {
  double share = 0.0, mean_m = 0.0, intensity = 0.0;
  bool finite = true;
};
Detected detect(const LidarConfig& config, float range_m, float reflectivity) {
  const auto row = config.detector.make("detector", config, std::uint64_t{9});
  Detected out;
  double count = 0.0;
  for (std::uint64_t v = 0; v < 100; ++v) {
    Volley volley;
    volley.lasers = 1, volley.cycles = Volley::kCycles, volley.first_draw = 32 * v;
    volley.rays.resize(volley.packets());
    Echoes echoes;
    for (EchoPacket& packet : echoes.start(volley.packets()))
      for (std::size_t i = 0; i < EchoPacket::kShots; ++i) packet.set(i, {{range_m, 1.0f, 0, 0}, reflectivity});
    (*row)->detect(volley, echoes);
    for (const EchoPacket& packet : echoes.layer(0))
      for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
        const float m = packet.measured_m[i], intensity = packet.intensity[i];
        const bool some = m != 0.0f && m < kNone;
        if (!some && m == m) continue;
        out.finite = out.finite && std::isfinite(m) && intensity >= 0.0f && intensity <= 1.0f;
        count += 1.0, out.mean_m += m, out.intensity += intensity;
      }
  }
  out.share = count / 3200.0;
  if (count > 0.0) out.mean_m /= count, out.intensity /= count;
  return out;
}

/// Of no echo, no light, next to none: nothing is detected (at six times the noise by chance 1e-9 of them). A figure
/// counts detections.
StressFigure no_signal() {
  const LidarConfig c = with_keys("detector = \"radiometric\"");
  StressFigure out;
  for (const auto& [range, reflectivity] :
       {std::pair(kNone, 0.0f), {30.0f, 0.0f}, {30.0f, 1e-38f}, {0.0f, 0.0f}, {1e30f, 1.0f}, {30.0f, -0.0f}}) {
    const Detected got = detect(c, range, reflectivity);
    out.figure += got.finite ? got.share * 3200.0 : 1e9;
  }
  return out;
}

/// At the threshold half of the echoes are found, at 10 % and 50 m; a margin of x noise off it Phi(x): five deviations
/// of 3200.
StressFigure threshold(double noises_above) {
  const LidarConfig c = with_keys("detector = \"radiometric\"\nthreshold_snr = 6.0");
  const double exact = 0.5 * std::erfc(-noises_above / std::sqrt(2.0));
  const Detected got = detect(c, 50.0f, static_cast<float>(0.1 * (1.0 + noises_above / 6.0)));
  return {std::abs(got.share - exact), 5.0 * std::sqrt(exact * (1.0 - exact) / 3200.0)};
}

/// A clipped signal: found each time, of intensity 1, its range short by walk * log10(signal / saturation). The mean of
/// 3200 of 0.02 m noise: five deviations, and half a unit of 10 m.
StressFigure saturated(double reflectivity, double walk_m) {
  const std::string keys = printed(
      "detector = \"radiometric\"\nsaturation = 1000.0\nsaturation_walk_m = %.17g\nrange_noise_m = 0.02", walk_m);
  const LidarConfig c = with_keys(keys);
  const Detected got = detect(c, 10.0f, static_cast<float>(reflectivity));
  const double signal = reflectivity * 10.0 * 25.0;
  const double exact = 10.0 - (signal > 1000.0 ? walk_m * std::log10(signal / 1000.0) : 0.0);
  StressFigure out{std::abs(got.mean_m - exact), 5.0 * 0.02 / std::sqrt(3200.0) + kHalfUlp * 10.0};
  if (!got.finite || got.share != 1.0 || got.intensity != 1.0) out.figure = std::numeric_limits<double>::infinity();
  return out;
}

/// The ideal detector, without noise: the range itself, its reflectivity within 0 and 1, whatever they are; a figure
/// counts what differs.
StressFigure ideal() {
  const LidarConfig c = with_keys("detector = \"ideal\"\nrange_noise_m = 0.0");
  StressFigure out;
  for (const float range : {1e-30f, 1e-3f, 100.0f, 1e30f})
    for (const float reflectivity : {-1.0f, 0.0f, 0.25f, 1.0f, 1e30f, kNone, std::numeric_limits<float>::quiet_NaN()}) {
      const Detected got = detect(c, range, reflectivity);
      out.figure += got.finite && got.share == 1.0 && static_cast<float>(got.mean_m) == range ? 0.0 : 1.0;
    }
  return out;
}

/// Forty echoes put in backwards, of which two stand in one place: the nearest 32, in order, the first to come first.
/// A figure counts what is out of place.
StressFigure more_echoes_than_fit() {
  Echoes echoes;
  for (EchoPacket& packet : echoes.start(2))
    for (std::size_t i = 0; i < EchoPacket::kShots; ++i) packet.set(i, {});
  StressFigure out;
  for (int k = 40; k >= 1; --k)
    echoes.insert(7, {{static_cast<float>(k / 2), 1.0f, static_cast<std::uint16_t>(k), 0}, 1.0f});
  out.figure += std::abs(static_cast<double>(echoes.layers()) - 32.0);
  float before = -1.0f;
  std::uint16_t material = 0;
  for (std::size_t l = 0; l < echoes.layers(); ++l) {
    const Echo here = echoes.layer(l)[0].at(7);
    out.figure += here.any() && here.truth.range_m >= before ? 0.0 : 1.0;
    // Of a pair k, k + 1 in one place, k + 1 came first.
    if (here.truth.range_m == before) out.figure += here.truth.material + 1 == material ? 0.0 : 1.0;
    before = here.truth.range_m, material = here.truth.material;
    for (const std::size_t other : {6, 8}) out.figure += echoes.layer(l)[0].at(other).any() ? 1.0 : 0.0;
  }
  out.figure += before == 16.0f || before == 15.0f ? 0.0 : 1.0;
  return out;
}

/// Each mode of none, one, two equals and thirty-two equals: the counts and the layers that the documentation says. A
/// figure counts what differs.
StressFigure choices() {
  StressFigure out;
  const auto expect = [&](ReturnMode mode, std::vector<float> strengths, const std::vector<std::size_t>& layers) {
    std::vector<DetectedEcho> echoes;
    for (std::size_t k = 0; k < strengths.size(); ++k) echoes.push_back({k, strengths[k]});
    echoes.resize(32);
    const std::size_t count = choose_returns(mode, echoes.data(), strengths.size());
    out.figure += count == layers.size() ? 0.0 : 1.0;
    for (std::size_t k = 0; k < std::min(count, layers.size()); ++k)
      out.figure += echoes[k].layer == layers[k] ? 0.0 : 1.0;
  };
  const std::vector<float> equal(32, 1.0f);
  for (const ReturnMode mode :
       {ReturnMode::kStrongest, ReturnMode::kFirst, ReturnMode::kLast, ReturnMode::kDual, ReturnMode::kAll}) {
    expect(mode, {}, {});
    expect(mode, {0.0f}, {0});
  }
  expect(ReturnMode::kStrongest, {1.0f, 1.0f}, {0}), expect(ReturnMode::kStrongest, equal, {0});
  expect(ReturnMode::kStrongest, {0.0f, kNone, 5.0f}, {1});
  expect(ReturnMode::kFirst, equal, {0}), expect(ReturnMode::kLast, equal, {31});
  expect(ReturnMode::kDual, {1.0f, 1.0f}, {0, 1}), expect(ReturnMode::kDual, equal, {0, 31});
  expect(ReturnMode::kDual, {3.0f, 1.0f, 9.0f}, {0, 2}), expect(ReturnMode::kDual, {1.0f, 3.0f, 2.0f}, {1, 2});
  return out;
}

}  // namespace

std::vector<StressCase> receiver_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "a detector of no signal",
           "the logarithm or the timing of nothing; noise taken for an echo", "none is found of 19,200", "detections"});
  rows.add("receivers/no_signal", no_signal);
  rows.of({StressGroup::kStiff, "a detector about its threshold", "a threshold in other units than the noise",
           "Phi(x), five deviations of 3200", ""});
  for (const double x : {-2.0, 0.0, 1.0}) {
    rows.add(printed("receivers/threshold_%s%g_noises", x < 0 ? "minus_" : "", std::abs(x)),
             [x] { return threshold(x); });
  }
  rows.of({StressGroup::kStiff, "a detector far beyond its saturation",
           "a walk that goes below the sensor, an intensity above 1",
           "short by walk * log10(signal / saturation), five deviations of the mean", "m"});
  rows.add("receivers/just_below_saturation", [] { return saturated(3.999, 0.5); })
      .add("receivers/10_times_saturated", [] { return saturated(40.0, 0.5); })
      .add("receivers/1e10_times_saturated", [] { return saturated(4e10, 0.5); });
  rows.of({StressGroup::kData, "an ideal detector of impossible light", "an intensity of NaN or above 1",
           "the range itself, the intensity within 0 and 1", "wrong"});
  rows.add("receivers/ideal_of_impossible_light", ideal);
  rows.of({StressGroup::kData, "more echoes than fit, and equals",
           "the farthest is kept for the nearest, or a neighbour's lane written", "the nearest 32 in order", "wrong"});
  rows.add("receivers/more_echoes_than_fit", more_echoes_than_fit);
  rows.of({StressGroup::kData, "returns chosen of none, one and equals",
           "the last and the strongest told as two where they are one", "as documented for each mode", "wrong"});
  rows.add("receivers/choices", choices);
  return rows.take();
}

}  // namespace canyon::lidar
