#include "canyon/core/process/vector_clones.h"
#include "canyon/lidar/lidar_config.h"

namespace canyon::lidar {
namespace {

CANYON_VECTOR_CLONES void measure(double sigma_m, const double* normals, EchoPacket& echoes) {
  float measured_m[EchoPacket::kShots], intensity[EchoPacket::kShots];
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) {
    measured_m[i] = static_cast<float>(static_cast<double>(echoes.range_m[i]) + sigma_m * normals[i]);
    const float share = echoes.reflectivity[i] > 0.0f ? echoes.reflectivity[i] : 0.0f;
    intensity[i] = share < 1.0f ? share : 1.0f;
  }
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) echoes.measured_m[i] = measured_m[i];
  for (std::size_t i = 0; i < EchoPacket::kShots; ++i) echoes.intensity[i] = intensity[i];
}

/// Noise: stream "lidar.range", entity = laser, index = firing cycle since the first scan, n = echo of the shot.
/// Intensity is the apparent reflectivity, as a sensor calibrated for range reports it.
class IdealDetector final : public Detector {
 public:
  IdealDetector(const LidarConfig& config, std::uint64_t seed)
      : sigma_m_(config.range_noise_m), noise_(seed, "lidar.range") {}

  void detect(const Volley& volley, Echoes& echoes) const override {
    thread_local std::vector<double> normals;
    normals.assign(volley.shots(), 0.0);
    for (std::size_t k = 0; k < echoes.layers(); ++k) {
      if (sigma_m_ > 0) fill_shot_normals(noise_, volley, k, normals);
      const std::span<EchoPacket> layer = echoes.layer(k);
      for (std::size_t p = 0; p < layer.size(); ++p) measure(sigma_m_, normals.data() + p * Volley::kLanes, layer[p]);
    }
  }

 private:
  double sigma_m_;
  RandomStream noise_;
};

}  // namespace

std::unique_ptr<Detector> make_ideal_detector(const ModelParameters&, const LidarConfig& config, std::uint64_t seed) {
  return std::make_unique<IdealDetector>(config, seed);
}

}  // namespace canyon::lidar
