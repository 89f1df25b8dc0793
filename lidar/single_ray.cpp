#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/units.h"
#include "lidar/scanner_models.h"
#include "lidar/sweep_motion.h"

namespace canyon::lidar {
namespace {

/// One thin ray per firing.
///
/// The head spins clockwise seen from above, as Velodyne's do, at a constant rate, and starts and ends its revolution
/// looking backwards (-x of L), so that the seam between two scans lies behind. Cycle c of a revolution starts at t -
/// period + c * step + (step - last firing time); its beam j fires firing_s later, so the last firing is at t exactly,
/// and the head turns on between the beams of one cycle. Each ray leaves from where the sensor truly is at that
/// instant. Measured range = true range + noise, rounded to the quantum; what then lies outside [min, max] is not
/// reported. Intensity is reflectance times the cosine of incidence: the range-compensated reflectivity of a Lambertian
/// surface. Points come in the order of firing: cycle by cycle, within a cycle by firing time (equal times: by laser).
///
/// Noise: stream "lidar.range", entity = laser, index = revolution * azimuth_steps + cycle.
class SingleRay final : public Scanner {
 public:
  SingleRay(const LidarConfig& config, const BeamTable& table, std::uint64_t seed)
      : config_(config),
        beams_(table.beams),
        steps_(static_cast<std::size_t>(config.azimuth_steps)),
        period_s_(1.0 / config.rate_hz),
        X_BL_(sensor_in_body(config)),
        noise_(seed, "lidar.range") {
    const double step_s = period_s_ / static_cast<double>(steps_);
    const double start_s = step_s - table.last_firing_s() - period_s_;
    time_s_.resize(rays_per_scan());
    direction_L_.resize(rays_per_scan());
    shot_.resize(rays_per_scan());
    for (std::size_t j = 0; j < beams_.size(); ++j) {
      const Beam& beam = beams_[j];
      for (std::size_t c = 0; c < steps_; ++c) {
        const double elapsed_s = static_cast<double>(c) * step_s + beam.firing_s;
        // Clockwise from -x.
        const double azimuth = beam.azimuth_offset_rad + 2.0 * kPi * elapsed_s / period_s_;
        time_s_[j * steps_ + c] = std::min(0.0, start_s + elapsed_s);
        direction_L_[j * steps_ + c] = {-std::cos(beam.elevation_rad) * std::cos(azimuth),
                                        std::cos(beam.elevation_rad) * std::sin(azimuth), std::sin(beam.elevation_rad)};
      }
    }
    firing_order_.resize(beams_.size());
    std::iota(firing_order_.begin(), firing_order_.end(), std::size_t{0});
    std::stable_sort(firing_order_.begin(), firing_order_.end(),
                     [&](std::size_t a, std::size_t b) { return beams_[a].firing_s < beams_[b].firing_s; });
  }

  LidarOutput scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    LidarOutput out;
    out.scan.t = t;
    out.scan.period_s = period_s_;
    if (config_.blinded) return out;
    const SweepMotion motion(truth, t, -period_s_, 0.0, Pose{}, X_BL_);
    CANYON_CHECK(motion.covers(-period_s_) && motion.covers(0.0),
                 "the true motion does not cover the sweep that ends at ", t.iso());
    // One ring per task: neighbouring azimuths of one laser make the most coherent packets for the ray tracer, and
    // every ray has its own slot, so the result does not depend on the number of threads.
    parallel_for(beams_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) shoot_ring(j, index, motion, scene);
    });
    collect(scene, out);
    rays_ += static_cast<std::int64_t>(rays_per_scan());
    return out;
  }

  std::int64_t rays() const override { return rays_; }

 private:
  /// What one ray measured.
  struct Shot {
    float measured_m;  // 0: nothing reported
    float range_m;
    float cos_incidence;
    std::uint32_t triangle;
  };

  std::size_t rays_per_scan() const { return beams_.size() * steps_; }

  void shoot_ring(std::size_t j, std::int64_t index, const SweepMotion& motion, const scene::SceneAt& scene) {
    thread_local std::vector<scene::Ray> rays;
    thread_local std::vector<scene::Hit> hits;
    thread_local std::vector<double> noise;
    rays.resize(steps_);
    hits.resize(steps_);
    noise.resize(steps_);
    const Eigen::Vector3d origin_L(0, 0, beams_[j].origin_up_m);
    const std::size_t first = j * steps_;
    // Noise may bring a surface just beyond the limit into view.
    const double reach_m = config_.max_range_m + 8.0 * config_.range_noise_m;
    std::size_t hint = 0;
    for (std::size_t c = 0; c < steps_; ++c) {
      const auto X_WL = motion.at(time_s_[first + c], hint);
      rays[c].origin = (X_WL * origin_L).cast<float>();
      rays[c].direction = (X_WL.R * direction_L_[first + c]).cast<float>();
      rays[c].max_m = static_cast<float>(reach_m);
    }
    scene.trace(rays, hits);
    const auto laser = static_cast<std::uint32_t>(j);
    noise_.fill_normal(noise, laser, static_cast<std::uint64_t>(index) * steps_);
    for (std::size_t c = 0; c < steps_; ++c) {
      Shot& shot = shot_[first + c];
      shot.measured_m = 0;
      const scene::Hit& hit = hits[c];
      if (!hit.hit()) continue;
      double measured_m = hit.range_m + config_.range_noise_m * noise[c];
      if (config_.range_quantum_m > 0)
        measured_m = std::nearbyint(measured_m / config_.range_quantum_m) * config_.range_quantum_m;
      if (!(measured_m >= config_.min_range_m && measured_m <= config_.max_range_m && measured_m > 0)) continue;
      shot = {.measured_m = static_cast<float>(measured_m),
              .range_m = hit.range_m,
              .cos_incidence = std::clamp(-hit.normal.dot(rays[c].direction), 0.0f, 1.0f),
              .triangle = hit.triangle};
    }
  }

  void collect(const scene::SceneAt& scene, LidarOutput& out) const {
    const auto& materials = scene.scene().materials();
    out.scan.points.reserve(rays_per_scan());
    out.truth.reserve(rays_per_scan());
    for (std::size_t c = 0; c < steps_; ++c) {
      for (std::size_t j : firing_order_) {
        const std::size_t i = j * steps_ + c;
        const Shot& shot = shot_[i];
        if (shot.measured_m == 0) continue;
        const scene::SceneAt::Surface surface = scene.surface(shot.triangle);
        Eigen::Vector3d p_L = static_cast<double>(shot.measured_m) * direction_L_[i];
        p_L.z() += beams_[j].origin_up_m;
        const double reflectivity = materials[surface.material].lidar_reflectance * shot.cos_incidence;
        out.scan.points.push_back({.x = static_cast<float>(p_L.x()),
                                   .y = static_cast<float>(p_L.y()),
                                   .z = static_cast<float>(p_L.z()),
                                   .intensity = static_cast<float>(std::clamp(reflectivity, 0.0, 1.0)),
                                   .time_s = static_cast<float>(time_s_[i]),
                                   .ring = static_cast<std::uint16_t>(j),
                                   .return_index = 0});
        out.truth.push_back({.range_m = shot.range_m,
                             .cos_incidence = shot.cos_incidence,
                             .material = surface.material,
                             .object = surface.object});
      }
    }
  }

  LidarConfig config_;
  std::vector<Beam> beams_;
  std::size_t steps_;
  double period_s_;
  Pose X_BL_;
  RandomStream noise_;
  std::vector<std::size_t> firing_order_;
  // Per ray, ring after ring.
  std::vector<double> time_s_;
  std::vector<Eigen::Vector3d> direction_L_;
  std::vector<Shot> shot_;
  std::int64_t rays_ = 0;
};

}  // namespace

std::unique_ptr<Scanner> make_single_ray(const LidarConfig& config, const BeamTable& table, std::uint64_t seed) {
  return std::make_unique<SingleRay>(config, table, seed);
}

}  // namespace canyon::lidar
