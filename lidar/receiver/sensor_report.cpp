#include "canyon/lidar/receiver/sensor_report.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "canyon/core/process/vector_clones.h"
#include "canyon/core/random/random.h"

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

void visit(FieldVisitor& f, ReportConfig& c) {
  f.choice("returns", c.returns, return_modes(),
           with_rows("which echoes of a shot are reported", return_modes()).c_str());
  f.number("min_range_m", c.min_range_m, {0, 1e4}, "shorter measured ranges are not reported");
  f.number("max_range_m", c.max_range_m, {0, 1e4}, "longer measured ranges are not reported");
  f.number("range_quantum_m", c.range_quantum_m, {0, 1}, "step of the reported range; 0 = continuous");
  f.number("range_bias_m", c.range_bias_m, {0, 10}, "1-sigma of the constant range bias of each laser");
}

SensorReport::SensorReport(const ReportConfig& config, const SignalConfig& signal, const FiringPattern& pattern,
                           std::uint64_t seed)
    : mode_(config.returns),
      quantum_m_(config.range_quantum_m),
      min_m_(config.min_range_m),
      max_m_(config.max_range_m),
      overlap_m2_(full_overlap_m2(signal)),
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
  out.total = 0;
  if (out.layers.size() < most) out.layers.resize(most);
  for (std::size_t k = 0; k < most; ++k) out.layers[k].resize(volley.packets());
  std::array<DetectedEcho, Echoes::kMost> detected;
  for (std::size_t p = 0; p < volley.packets(); ++p) {
    const Limits limits{bias_m_[p / Volley::kPacketsPerLaser], quantum_m_, min_m_, max_m_};
    alignas(64) float ranges[Echoes::kMost][kShots];
    for (std::size_t k = 0; k < layers; ++k) report_ranges(echoes.layer(k)[p], limits, ranges[k]);
    if (layers == 1) {
      const EchoPacket& echo = echoes.layer(0)[p];
      std::memcpy(out.layers[0][p].truth, echo.truth, sizeof echo.truth);
      place_points(ranges[0], volley.aims[p], echo.intensity, out.layers[0][p]);
    } else {
      alignas(64) float chosen[Echoes::kMost][kShots], intensity[Echoes::kMost][kShots];
      for (std::size_t k = 0; k < most; ++k) {
        std::fill_n(chosen[k], kShots, 0.0f);
        std::fill_n(intensity[k], kShots, 0.0f);
      }
      for (std::size_t lane = 0; lane < kShots; ++lane) {
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
    for (std::size_t k = 0; k < most; ++k) {
      std::uint32_t count = 0;
      for (const std::uint32_t reported : out.layers[k][p].reported) count += reported;
      out.total += count;
    }
  }
}

void SensorReport::write(const VolleyReturns& returns, std::span<LidarPoint> points,
                         std::span<LidarPointTruth> truth) const {
  std::array<const ReturnPacket*, Echoes::kMost> layers{};
  for (std::size_t k = 0; k < returns.depth; ++k) layers[k] = returns.layers[k].data();
  LidarPoint* point = points.data();
  LidarPointTruth* fact = truth.data();
  for (std::size_t c = 0; c < returns.cycles; ++c) {
    const std::size_t lane = c % kShots;
    const double cycle_s = returns.first_s + static_cast<double>(c) * returns.step_s;
    for (const std::size_t laser : firing_order_) {
      const std::size_t packet = Volley::shot(laser, c) / kShots;
      const auto time_s = static_cast<float>(std::min(0.0, cycle_s + firing_s_[laser]));
      for (std::size_t k = 0; k < returns.depth; ++k) {
        const ReturnPacket& r = layers[k][packet];
        if (r.reported[lane] == 0) break;
        const ReturnPacket::Light light = r.light[lane];
        *point++ = {.x = light.x,
                    .y = light.y,
                    .z = light.z,
                    .intensity = light.intensity,
                    .time_s = time_s,
                    .ring = static_cast<std::uint16_t>(laser),
                    .return_index = static_cast<std::uint8_t>(k)};
        *fact++ = r.truth[lane];
      }
    }
  }
}

}  // namespace canyon::lidar
