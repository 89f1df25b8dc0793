#include "lidar/sensor_report.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/random.h"
#include "core/vector_clones.h"

namespace canyon::lidar {
namespace {

constexpr std::size_t kShots = ReturnPacket::kShots;

/// Nearest whole number, halves to even, for |x| < 2^51: what nearbyint gives, without a call.
[[gnu::always_inline]] inline double rounded(double x) {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52
  return (x + kShift) - kShift;
}

struct Limits {
  double bias_m, quantum_m, min_m, max_m;
};

/// Measured ranges with bias, in whole quanta; 0 outside the limits or where nothing was detected.
CANYON_VECTOR_CLONES void report_ranges(const EchoPacket& echoes, const Limits& limits, float* out) {
  const Limits l = limits;
  const bool stepped = l.quantum_m > 0;
  const double quantum_m = stepped ? l.quantum_m : 1.0;
  float reported[kShots];
  for (std::size_t i = 0; i < kShots; ++i) {
    const double measured_m = echoes.measured_m[i];
    const double biased_m = measured_m + l.bias_m;
    const double whole_m = rounded(biased_m / quantum_m) * quantum_m;
    const double range_m = stepped ? whole_m : biased_m;
    const bool within = (measured_m > 0) & (range_m >= l.min_m) & (range_m <= l.max_m) & (range_m > 0);
    reported[i] = within ? static_cast<float>(range_m) : 0.0f;
  }
  for (std::size_t i = 0; i < kShots; ++i) out[i] = reported[i];
}

/// Points along the beams at the reported ranges.
CANYON_VECTOR_CLONES void place_points(const float* ranges, const AimPacket& aim, const float* intensity,
                                       ReturnPacket& out) {
  ReturnPacket::Light light[kShots];
  for (std::size_t i = 0; i < kShots; ++i) {
    light[i].x = aim.origin_x[i] + ranges[i] * aim.direction_x[i];
    light[i].y = aim.origin_y[i] + ranges[i] * aim.direction_y[i];
    light[i].z = aim.origin_z[i] + ranges[i] * aim.direction_z[i];
    light[i].intensity = intensity[i];
  }
  for (std::size_t i = 0; i < kShots; ++i) out.light[i] = light[i];
  for (std::size_t i = 0; i < kShots; ++i) out.reported[i] = ranges[i] > 0.0f ? 1 : 0;
}

}  // namespace

std::size_t VolleyReturns::total() const {
  return std::accumulate(count.begin(), count.end(), std::size_t{0});
}

SensorReport::SensorReport(const LidarConfig& config, ReturnMode mode, const FiringPattern& pattern, std::uint64_t seed)
    : mode_(mode),
      quantum_m_(config.range_quantum_m),
      min_m_(config.min_range_m),
      max_m_(config.max_range_m),
      overlap_m2_(full_overlap_m2(config)),
      firing_order_(pattern.firing_order()) {
  const RandomStream bias(seed, "lidar.range_bias");
  for (std::uint32_t laser = 0; laser < pattern.lasers(); ++laser) {
    bias_m_.push_back(config.range_bias_m * bias.normal(laser, 0));
    firing_s_.push_back(pattern.table().beams[laser].firing_s);
  }
}

void SensorReport::choose(const Volley& volley, const Echoes& echoes, VolleyReturns& out) const {
  const std::size_t layers = echoes.layers();
  const std::size_t most = most_returns() == 0 ? layers : std::min(layers, most_returns());
  out.depth = most;
  out.lasers = volley.lasers, out.cycles = volley.cycles;
  out.first_s = volley.first_s, out.step_s = volley.step_s;
  out.count.fill(0);
  if (out.layers.size() < most) out.layers.resize(most);
  for (std::size_t k = 0; k < most; ++k) out.layers[k].resize(volley.packets());
  for (std::size_t p = 0; p < volley.packets(); ++p) {
    const Limits limits{bias_m_[p / Volley::kPacketsPerLaser], quantum_m_, min_m_, max_m_};
    alignas(64) float ranges[Echoes::kMost][kShots];
    for (std::size_t k = 0; k < layers; ++k) report_ranges(echoes.layer(k)[p], limits, ranges[k]);
    if (layers == 1) {
      const EchoPacket& echo = echoes.layer(0)[p];
      std::memcpy(out.layers[0][p].truth, echo.truth, sizeof echo.truth);
      place_points(ranges[0], volley.aims[p], echo.intensity, out.layers[0][p]);
    } else {
      alignas(64) float chosen[Echoes::kMost][kShots] = {}, intensity[Echoes::kMost][kShots] = {};
      for (std::size_t lane = 0; lane < kShots; ++lane) {
        std::array<DetectedEcho, Echoes::kMost> detected;
        std::size_t count = 0;
        for (std::size_t k = 0; k < layers; ++k) {
          if (!(ranges[k][lane] > 0)) continue;
          const EchoPacket& echo = echoes.layer(k)[p];
          const float square_m2 = echo.range_m[lane] * echo.range_m[lane];
          detected[count++] = {k, echo.reflectivity[lane] / std::max(square_m2, overlap_m2_)};
        }
        count = choose_returns(mode_, detected.data(), count);
        for (std::size_t k = 0; k < count; ++k) {
          const EchoPacket& echo = echoes.layer(detected[k].layer)[p];
          chosen[k][lane] = ranges[detected[k].layer][lane];
          intensity[k][lane] = echo.intensity[lane];
          out.layers[k][p].truth[lane] = echo.truth[lane];
        }
      }
      for (std::size_t k = 0; k < most; ++k) place_points(chosen[k], volley.aims[p], intensity[k], out.layers[k][p]);
    }
    std::uint32_t* count = out.count.data() + p % Volley::kPacketsPerLaser * kShots;
    for (std::size_t k = 0; k < most; ++k)
      for (std::size_t lane = 0; lane < kShots; ++lane) count[lane] += out.layers[k][p].reported[lane];
  }
}

void SensorReport::write(const VolleyReturns& returns, std::span<LidarPoint> points,
                         std::span<LidarPointTruth> truth) const {
  // Laser by laser, as the returns lie in memory; each cycle has its own place to go on at.
  std::array<std::uint32_t, Volley::kCycles> next{};
  std::array<double, Volley::kCycles> cycle_s{};
  std::array<float, Volley::kCycles> time_s{};
  for (std::size_t c = 0; c < Volley::kCycles; ++c) {
    next[c] = c == 0 ? 0 : next[c - 1] + returns.count[c - 1];
    cycle_s[c] = returns.first_s + static_cast<double>(c) * returns.step_s;
  }
  LidarPoint* const point = points.data();
  LidarPointTruth* const fact = truth.data();
  for (const std::size_t laser : firing_order_) {
    const double firing_s = firing_s_[laser];
    for (std::size_t c = 0; c < Volley::kCycles; ++c)
      time_s[c] = static_cast<float>(std::min(0.0, cycle_s[c] + firing_s));
    for (std::size_t c = 0; c < returns.cycles; ++c) {
      const std::size_t packet = Volley::shot(laser, c) / kShots, lane = c % kShots;
      for (std::size_t k = 0; k < returns.depth; ++k) {
        const ReturnPacket& r = returns.layers[k][packet];
        if (r.reported[lane] == 0) break;
        const std::uint32_t i = next[c]++;
        const ReturnPacket::Light light = r.light[lane];
        point[i] = {.x = light.x,
                    .y = light.y,
                    .z = light.z,
                    .intensity = light.intensity,
                    .time_s = time_s[c],
                    .ring = static_cast<std::uint16_t>(laser),
                    .return_index = static_cast<std::uint8_t>(k)};
        fact[i] = r.truth[lane];
      }
    }
  }
}

}  // namespace canyon::lidar
