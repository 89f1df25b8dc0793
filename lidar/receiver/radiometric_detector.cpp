#include <algorithm>
#include <cmath>
#include <limits>

#include "canyon/core/process/vector_clones.h"
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

/// What the loop over a packet needs.
struct Receiver {
  double range_at_10_percent_m, least_m, threshold_snr, pulse_m, sigma_m;
};

CANYON_VECTOR_CLONES void receive(const Receiver& receiver, const double* signal_normals, const double* range_normals,
                                  EchoPacket& echoes, double* signals) {
  const Receiver r = receiver;
  const double faintest_edge_m = 2.0 * r.threshold_snr;
  float measured_m[EchoPacket::kShots], intensity[EchoPacket::kShots];
  double sent[EchoPacket::kShots];
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
    const double range_m = echoes.range_m[i];
    const double ratio = r.range_at_10_percent_m / (range_m > r.least_m ? range_m : r.least_m);
    const double gain = 10.0 * ratio * ratio;  // signal_gain()
    const double signal = static_cast<double>(echoes.reflectivity[i]) * gain;
    const double received = signal + signal_normals[i] / r.threshold_snr;
    const double edge_m = r.pulse_m / (faintest_edge_m * (signal > 1.0 ? signal : 1.0));
    const double sigma_m = std::sqrt(r.sigma_m * r.sigma_m + edge_m * edge_m);
    const double timed_m = range_m + sigma_m * range_normals[i];
    const double share = received / gain;
    const bool detected = (range_m < std::numeric_limits<double>::infinity()) & (received > 1.0);
    measured_m[i] = detected ? static_cast<float>(timed_m) : 0.0f;
    intensity[i] = detected ? static_cast<float>(share < 1.0 ? share : 1.0) : 0.0f;
    sent[i] = detected ? signal : 0.0;
  }
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) echoes.measured_m[i] = measured_m[i];
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) echoes.intensity[i] = intensity[i];
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) signals[i] = sent[i];
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
      const Receiver receiver{signal_.range_at_10_percent_m, std::max(signal_.full_overlap_m, 0.01), p_.threshold_snr,
                              signal_.pulse_m, sigma_m_};
      std::size_t shot = 0;
      for (EchoPacket& packet : echoes.layer(k)) {
        double signals[EchoPacket::kShots];
        receive(receiver, signal_normals.data() + shot, range_normals.data() + shot, packet, signals);
        if (p_.saturation_walk_m > 0.0) clip(signals, range_normals.data() + shot, packet);
        shot += Volley::kLanes;
      }
    }
  }

  double weakest_edge_m() const override { return signal_.pulse_m / (2.0 * p_.threshold_snr); }
  double most_short_m() const override {
    constexpr double kBrightest = 1e40;  // signal of any single-precision reflectivity
    return p_.saturation_walk_m * std::log10(kBrightest / p_.saturation);
  }

 private:
  /// Ranges of echoes beyond saturation.
  void clip(const double* signals, const double* range_normals, EchoPacket& echoes) const {
    for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
      if (!(signals[i] > p_.saturation)) continue;
      const double edge_m = signal_.pulse_m / (2.0 * p_.threshold_snr * std::max(signals[i], 1.0));
      const double sigma_m = std::sqrt(sigma_m_ * sigma_m_ + edge_m * edge_m);
      const double measured_m = static_cast<double>(echoes.range_m[i]) + sigma_m * range_normals[i];
      echoes.measured_m[i] =
          static_cast<float>(measured_m - p_.saturation_walk_m * std::log10(signals[i] / p_.saturation));
    }
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
