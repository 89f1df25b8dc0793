#include <algorithm>

#include "lidar/detector.h"

namespace canyon::lidar {
namespace {

/// Noise: stream "lidar.range", entity = laser, index = firing cycle since the first scan, n = echo of the shot.
/// Intensity is the apparent reflectivity, as a sensor calibrated for range reports it.
class IdealDetector final : public Detector {
 public:
  IdealDetector(const LidarConfig& config, std::uint64_t seed)
      : sigma_m_(config.range_noise_m), noise_(seed, "lidar.range") {}

  void detect(const Volley& volley, EchoList& list) const override {
    thread_local std::vector<double> normals;
    if (sigma_m_ > 0) fill_shot_normals(noise_, volley, normals);
    for (std::size_t shot = 0; shot < volley.shots(); ++shot) {
      const std::uint32_t begin = list.first[shot], end = list.first[shot + 1];
      for (std::uint32_t e = begin; e < end; ++e) {
        Echo& echo = list.echoes[e];
        double noise = 0;
        if (sigma_m_ > 0) {
          noise = e == begin ? normals[shot]
                             : noise_.normal(static_cast<std::uint32_t>(Volley::laser_of(shot)), volley.draw_of(shot),
                                             e - begin);
        }
        echo.measured_m = static_cast<float>(echo.range_m + sigma_m_ * noise);
        echo.intensity = std::clamp(echo.reflectivity, 0.0f, 1.0f);
      }
    }
  }

 private:
  double sigma_m_;
  RandomStream noise_;
};

}  // namespace

std::unique_ptr<Detector> make_ideal_detector(const LidarConfig& config, std::uint64_t seed) {
  return std::make_unique<IdealDetector>(config, seed);
}

}  // namespace canyon::lidar
