#include <algorithm>
#include <cmath>

#include "lidar/detector.h"

namespace canyon::lidar {
namespace {

/// The radar equation of a target that fills the beam: received energy is proportional to apparent reflectivity /
/// range^2. It is counted in units of the detection threshold, and scaled so that a Lambertian target of 10 % square to
/// the beam reaches the threshold at `range_at_10_percent_m`:
///
///   signal = (reflectivity / 0.1) (range_at_10_percent / range)^2, constant nearer than full_overlap_m.
///
/// The receiver's noise is Gaussian, 1 / threshold_snr. An echo is detected if signal + noise > 1: half of those at the
/// threshold itself, Phi(threshold_snr (signal - 1)) elsewhere. Timing of an edge that rises over the pulse, in noise:
/// sigma^2 = range_noise^2 + (pulse / (2 threshold_snr signal))^2; at the threshold and below the second is that of
/// signal 1. Intensity is the reflectivity that the noisy signal speaks for, clipped to 1. Beyond `saturation` times
/// the threshold the amplifier clips: the edge is steeper than it seems and the range reads short by saturation_walk_m
/// for every factor of ten.
///
/// Streams "lidar.signal" and "lidar.range", entity = laser, index = firing cycle, n = echo of the shot.
class RadiometricDetector final : public Detector {
 public:
  RadiometricDetector(const LidarConfig& config, std::uint64_t seed)
      : config_(config), range_noise_(seed, "lidar.range"), signal_noise_(seed, "lidar.signal") {}

  void detect(const Volley& volley, EchoList& list) const override {
    thread_local std::vector<double> range_normals, signal_normals;
    fill_shot_normals(range_noise_, volley, range_normals);
    fill_shot_normals(signal_noise_, volley, signal_normals);
    for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
      const std::uint32_t begin = list.first[shot], end = list.first[shot + 1];
      const auto laser = static_cast<std::uint32_t>(Volley::laser_of(shot));
      for (std::uint32_t e = begin; e < end; ++e) {
        const bool first = e == begin;
        detect(list.echoes[e],
               first ? signal_normals[shot] : signal_noise_.normal(laser, volley.draw_of(shot), e - begin),
               first ? range_normals[shot] : range_noise_.normal(laser, volley.draw_of(shot), e - begin));
      }
    }
  }

 private:
  void detect(Echo& echo, double signal_normal, double range_normal) const {
    const double gain = signal_gain(config_, echo.range_m);
    const double signal = echo.reflectivity * gain;
    const double received = signal + signal_normal / config_.threshold_snr;
    echo.measured_m = 0;
    if (!(received > 1.0)) return;
    const double edge_m = config_.pulse_m / (2.0 * config_.threshold_snr * std::max(signal, 1.0));
    const double sigma_m = std::sqrt(config_.range_noise_m * config_.range_noise_m + edge_m * edge_m);
    double measured_m = echo.range_m + sigma_m * range_normal;
    if (signal > config_.saturation) measured_m -= config_.saturation_walk_m * std::log10(signal / config_.saturation);
    echo.measured_m = static_cast<float>(measured_m);
    echo.intensity = static_cast<float>(std::clamp(received / gain, 0.0, 1.0));
  }

  LidarConfig config_;
  RandomStream range_noise_, signal_noise_;
};

}  // namespace

std::unique_ptr<Detector> make_radiometric_detector(const LidarConfig& config, std::uint64_t seed) {
  return std::make_unique<RadiometricDetector>(config, seed);
}

}  // namespace canyon::lidar
