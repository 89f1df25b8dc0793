#include <algorithm>
#include <cmath>

#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {
namespace {

struct RadiometricParameters {
  double threshold_snr = 6.0;
  double saturation = 1000.0;
  double saturation_walk_m = 0.0;
};
void visit(FieldVisitor& f, RadiometricParameters& c) {
  f.number("threshold_snr", c.threshold_snr, {0.1, 1e3}, "detection threshold over the receiver's noise (radiometric)");
  f.number("saturation", c.saturation, {1, 1e9}, "signal over threshold from which the receiver clips (radiometric)");
  f.number("saturation_walk_m", c.saturation_walk_m, {0, 10},
           "how much a clipped range reads short, for every factor of ten (radiometric)");
}

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
  RadiometricDetector(const RadiometricParameters& p, const LidarConfig& config, std::uint64_t seed)
      : p_(p),
        signal_(config.signal),
        sigma_m_(config.range_noise_m),
        range_noise_(seed, "lidar.range"),
        signal_noise_(seed, "lidar.signal") {}

  void detect(const Volley& volley, Echoes& echoes) const override {
    thread_local std::vector<double> range_normals, signal_normals;
    for (std::size_t k = 0; k < echoes.layers(); ++k) {
      fill_shot_normals(range_noise_, volley, k, range_normals);
      fill_shot_normals(signal_noise_, volley, k, signal_normals);
      const double *range_normal = range_normals.data(), *signal_normal = signal_normals.data();
      for (EchoPacket& packet : echoes.layer(k))
        for (std::size_t lane = 0; lane < Volley::kLanes; ++lane)
          detect(packet, lane, *signal_normal++, *range_normal++);
    }
  }

  double weakest_edge_m() const override { return signal_.pulse_m / (2.0 * p_.threshold_snr); }

 private:
  void detect(EchoPacket& echoes, std::size_t lane, double signal_normal, double range_normal) const {
    echoes.measured_m[lane] = 0;
    echoes.intensity[lane] = 0;
    const float range_m = echoes.range_m[lane];
    if (range_m == Echo{}.truth.range_m) return;
    const double gain = signal_gain(signal_, range_m);
    const double signal = echoes.reflectivity[lane] * gain;
    const double received = signal + signal_normal / p_.threshold_snr;
    if (!(received > 1.0)) return;
    const double edge_m = signal_.pulse_m / (2.0 * p_.threshold_snr * std::max(signal, 1.0));
    const double sigma_m = std::sqrt(sigma_m_ * sigma_m_ + edge_m * edge_m);
    double measured_m = range_m + sigma_m * range_normal;
    if (signal > p_.saturation) measured_m -= p_.saturation_walk_m * std::log10(signal / p_.saturation);
    echoes.measured_m[lane] = static_cast<float>(measured_m);
    echoes.intensity[lane] = static_cast<float>(std::clamp(received / gain, 0.0, 1.0));
  }

  RadiometricParameters p_;
  SignalConfig signal_;
  double sigma_m_;  ///< of the range of a bright echo
  RandomStream range_noise_, signal_noise_;
};

}  // namespace

void radiometric_parameters(ModelParameters& section) {
  section.add<RadiometricParameters>();
}

std::unique_ptr<Detector> make_radiometric_detector(const ModelParameters& own, const LidarConfig& config,
                                                    std::uint64_t seed) {
  return std::make_unique<RadiometricDetector>(own.get<RadiometricParameters>(), config, seed);
}

}  // namespace canyon::lidar
