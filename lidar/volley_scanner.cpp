#include "lidar/volley_scanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/parallel.h"
#include "core/units.h"
#include "lidar/crosstalk.h"
#include "lidar/ego_mask.h"
#include "lidar/firing_pattern.h"
#include "lidar/sweep_motion.h"
#include "lidar/weather.h"

namespace canyon::lidar {
namespace {

/// Nearest whole number, halves to even, for |x| < 2^51: what nearbyint gives, without a call.
double rounded(double x) {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52
  return (x + kShift) - kShift;
}

class VolleyScanner final : public Scanner {
 public:
  VolleyScanner(const LidarConfig& config, BeamTable table, std::unique_ptr<EchoModel> model,
                std::unique_ptr<Detector> detector, ReturnMode returns, std::uint64_t seed)
      : config_(config),
        period_s_(1.0 / config.rate_hz),
        X_BL_(sensor_in_body(config)),
        pattern_(std::move(table), config.rate_hz, static_cast<std::size_t>(config.azimuth_steps)),
        model_(std::move(model)),
        detector_(std::move(detector)),
        returns_(returns),
        weather_(config, seed),
        crosstalk_(config, seed),
        ego_(config.ego_min_m, config.ego_max_m, X_BL_),
        angle_noise_(seed, "lidar.angle") {
    const RandomStream bias(seed, "lidar.range_bias");
    for (std::uint32_t laser = 0; laser < pattern_.lasers(); ++laser)
      bias_m_.push_back(config.range_bias_m * bias.normal(laser, 0));
  }

  LidarOutput scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    LidarOutput out;
    out.scan.t = t;
    out.scan.period_s = period_s_;
    if (config_.blinded) return out;
    const FiringPattern::Sweep sweep = pattern_.sweep(index);
    const SweepMotion motion = motion_of(t, truth, sweep);
    const Surfaces surfaces(scene, config_.wavelength_nm);
    const std::size_t volleys = volleys_of(sweep);
    if (pieces_.size() < volleys) pieces_.resize(volleys);
    // Each volley has a place of its own, so the result does not depend on the number of threads.
    parallel_for(volleys, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) run_chain(sweep, v, motion, scene, surfaces, pieces_[v]);
    });
    collect(volleys, out);
    rays_ += static_cast<std::int64_t>(sweep.cycles * pattern_.lasers() * model_->rays_per_shot());
    return out;
  }

  std::vector<float> true_ranges(std::int64_t index, GpsTime t, const Trajectory& truth,
                                 const scene::SceneAt& scene) override {
    const FiringPattern::Sweep sweep = pattern_.sweep(index);
    const SweepMotion motion = motion_of(t, truth, sweep);
    std::vector<float> out(pattern_.lasers() * sweep.cycles);
    parallel_for(volleys_of(sweep), 1, [&](std::size_t begin, std::size_t end) {
      thread_local Volley volley;
      thread_local std::vector<scene::HitPacket> hits;
      for (std::size_t v = begin; v < end; ++v) {
        fire(sweep, v, motion, config_.max_range_m, volley);
        hits.resize(volley.packets());
        scene.trace(volley.rays, hits);
        for (std::size_t laser = 0; laser < volley.lasers; ++laser) {
          float* ring = out.data() + laser * sweep.cycles + volley.first_cycle;
          for (std::size_t c = 0; c < volley.cycles; c += Volley::kLanes) {
            const float* range_m = hits[Volley::shot(laser, c) / Volley::kLanes].range_m;
            std::copy_n(range_m, std::min(Volley::kLanes, volley.cycles - c), ring + c);
          }
        }
      }
    });
    rays_ += static_cast<std::int64_t>(out.size());
    return out;
  }

  std::int64_t rays() const override { return rays_; }

 private:
  /// The points of one volley: the first `count` of vectors that only grow.
  struct Piece {
    std::vector<LidarPoint> points;
    std::vector<LidarPointTruth> truth;
    std::size_t count = 0;

    void add(const LidarPoint& point, const LidarPointTruth& fact) {
      if (count == points.size()) {
        points.resize(2 * count + 256);
        truth.resize(points.size());
      }
      points[count] = point;
      truth[count++] = fact;
    }
  };

  static std::size_t volleys_of(const FiringPattern::Sweep& sweep) {
    return (sweep.cycles + Volley::kCycles - 1) / Volley::kCycles;
  }

  SweepMotion motion_of(GpsTime t, const Trajectory& truth, const FiringPattern::Sweep& sweep) const {
    const double first_s = std::min(-period_s_, sweep.start_s);
    SweepMotion motion(truth, t - config_.latency_s, first_s, 0.0, Pose{}, X_BL_);
    CANYON_CHECK(motion.covers(first_s) && motion.covers(0.0), "the true motion does not cover the sweep that ends at ",
                 (t - config_.latency_s).iso());
    return motion;
  }

  /// Lays out the rays of volley v.
  void fire(const FiringPattern::Sweep& sweep, std::size_t v, const SweepMotion& motion, double reach_m,
            Volley& volley) const {
    const double step_s = pattern_.step_s();
    volley.lasers = pattern_.lasers();
    volley.first_cycle = v * Volley::kCycles;
    volley.cycles = std::min(Volley::kCycles, sweep.cycles - volley.first_cycle);
    volley.first_draw = sweep.first_cycle + volley.first_cycle;
    volley.first_s = sweep.start_s + static_cast<double>(volley.first_cycle) * step_s;
    volley.step_s = step_s;
    volley.aims.resize(volley.packets());
    volley.rays.resize(volley.packets());
    const bool whole = volley.cycles == Volley::kCycles;
    // Shots of one cycle are placed from one place each, those fired late in a long cycle from one of their own.
    constexpr double kSamePlace_s = 100e-6;
    double placed_s = -1.0;
    std::size_t hint = 0;
    for (std::size_t laser : pattern_.firing_order()) {
      const double firing_s = pattern_.table().beams[laser].firing_s;
      if (placed_s < 0 || firing_s - placed_s > kSamePlace_s) {
        placed_s = firing_s;
        for (std::size_t k = 0; k < Volley::kPacketsPerLaser; ++k) {
          const double offset_s = static_cast<double>(k * Volley::kLanes) * step_s;
          motion.placements(volley.first_s + offset_s + placed_s, step_s, hint, volley.placements[k]);
        }
      }
      for (std::size_t k = 0; k < Volley::kPacketsPerLaser; ++k) {
        const std::size_t packet = laser * Volley::kPacketsPerLaser + k;
        const std::size_t first = k * Volley::kLanes;
        scene::RayPacket& rays = volley.rays[packet];
        if (first >= volley.cycles) {
          rays = {};
          std::fill_n(rays.max_m, Volley::kLanes, -1.0f);
          continue;
        }
        pattern_.aim(sweep, laser, volley.first_cycle + first, volley.aims[packet]);
        const auto late_s = static_cast<float>(firing_s - placed_s);
        if (config_.angle_noise_deg > 0) {
          AimPacket shaken = volley.aims[packet];
          shake(laser, volley.first_draw + first, shaken);
          place_shots(shaken, volley.placements[k], late_s, static_cast<float>(reach_m), rays);
        } else {
          place_shots(volley.aims[packet], volley.placements[k], late_s, static_cast<float>(reach_m), rays);
        }
        if (!whole) {
          for (std::size_t i = 0; i < Volley::kLanes; ++i)
            if (first + i >= volley.cycles) rays.max_m[i] = -1.0f;
        }
        if (ego_.any()) ego_.hide(volley.aims[packet], rays);
      }
    }
  }

  /// True directions about the nominal ones. Stream "lidar.angle", entity = laser, index = firing cycle, n = axis.
  void shake(std::size_t laser, std::uint64_t first_draw, AimPacket& aim) const {
    const double sigma_rad = config_.angle_noise_deg * kDegree;
    for (std::size_t i = 0; i < Volley::kLanes; ++i) {
      Eigen::Vector3d d(aim.direction_x[i], aim.direction_y[i], aim.direction_z[i]);
      const Eigen::Vector3d across = d.unitOrthogonal(), along = d.cross(across);
      const auto entity = static_cast<std::uint32_t>(laser);
      d += sigma_rad * (angle_noise_.normal(entity, first_draw + i, 0) * across +
                        angle_noise_.normal(entity, first_draw + i, 1) * along);
      d.normalize();
      aim.direction_x[i] = static_cast<float>(d.x());
      aim.direction_y[i] = static_cast<float>(d.y());
      aim.direction_z[i] = static_cast<float>(d.z());
    }
  }

  void run_chain(const FiringPattern::Sweep& sweep, std::size_t v, const SweepMotion& motion,
                 const scene::SceneAt& scene, const Surfaces& surfaces, Piece& out) const {
    thread_local Volley volley;
    thread_local EchoList echoes;
    // Noise may bring a surface just beyond the limit into view.
    fire(sweep, v, motion, config_.max_range_m + 8.0 * config_.range_noise_m, volley);
    model_->trace(volley, scene, surfaces, echoes);
    weather_.apply(volley, echoes);
    crosstalk_.apply(volley, echoes);
    detector_->detect(volley, echoes);
    report(volley, scene, echoes, out);
  }

  /// Chosen returns as points, in the order of firing.
  void report(const Volley& volley, const scene::SceneAt& scene, const EchoList& list, Piece& out) const {
    out.count = 0;
    for (std::size_t c = 0; c < volley.cycles; ++c) {
      const double cycle_s = volley.first_s + static_cast<double>(c) * volley.step_s;
      for (const std::size_t laser : pattern_.firing_order()) {
        const std::size_t shot = Volley::shot(laser, c);
        const std::uint32_t begin = list.first[shot], end = list.first[shot + 1];
        if (begin == end) continue;
        std::array<const Echo*, kMostEchoes> chosen;
        std::size_t count = 0;
        for (std::uint32_t e = begin; e < end && count < kMostEchoes; ++e) {
          if (reported(list.echoes[e], laser) > 0) chosen[count++] = &list.echoes[e];
        }
        count = choose_returns(returns_, chosen.data(), count);
        if (count == 0) continue;
        const double time_s = std::min(0.0, cycle_s + pattern_.table().beams[laser].firing_s);
        const AimPacket& aim = volley.aims[shot / Volley::kLanes];
        const std::size_t lane = shot % Volley::kLanes;
        for (std::size_t k = 0; k < count; ++k) {
          const Echo& echo = *chosen[k];
          const float range_m = reported(echo, laser);
          scene::SceneAt::Surface surface{.material = kNoMaterial, .object = kNoObject};
          if (echo.triangle != scene::Hit::kMiss) surface = scene.surface(echo.triangle);
          out.add({.x = aim.origin_x[lane] + range_m * aim.direction_x[lane],
                   .y = aim.origin_y[lane] + range_m * aim.direction_y[lane],
                   .z = aim.origin_z[lane] + range_m * aim.direction_z[lane],
                   .intensity = echo.intensity,
                   .time_s = static_cast<float>(time_s),
                   .ring = static_cast<std::uint16_t>(laser),
                   .return_index = static_cast<std::uint8_t>(k)},
                  {.range_m = echo.range_m,
                   .cos_incidence = echo.cos_incidence,
                   .material = surface.material,
                   .object = surface.object});
        }
      }
    }
  }

  /// With bias, in whole quanta; 0 outside the limits or where nothing was detected.
  float reported(const Echo& echo, std::size_t laser) const {
    if (!(echo.measured_m > 0)) return 0;
    double range_m = echo.measured_m + bias_m_[laser];
    if (config_.range_quantum_m > 0) range_m = rounded(range_m / config_.range_quantum_m) * config_.range_quantum_m;
    const bool within = range_m >= config_.min_range_m && range_m <= config_.max_range_m && range_m > 0;
    return within ? static_cast<float>(range_m) : 0;
  }

  void collect(std::size_t volleys, LidarOutput& out) const {
    std::size_t total = 0;
    for (std::size_t v = 0; v < volleys; ++v) total += pieces_[v].count;
    out.scan.points.reserve(total);
    out.truth.reserve(total);
    for (std::size_t v = 0; v < volleys; ++v) {
      const Piece& piece = pieces_[v];
      const auto count = static_cast<std::ptrdiff_t>(piece.count);
      out.scan.points.insert(out.scan.points.end(), piece.points.begin(), piece.points.begin() + count);
      out.truth.insert(out.truth.end(), piece.truth.begin(), piece.truth.begin() + count);
    }
  }

  static constexpr std::size_t kMostEchoes = 32;

  LidarConfig config_;
  double period_s_;
  Pose X_BL_;
  FiringPattern pattern_;
  std::unique_ptr<EchoModel> model_;
  std::unique_ptr<Detector> detector_;
  ReturnMode returns_;
  Weather weather_;
  Crosstalk crosstalk_;
  EgoMask ego_;
  RandomStream angle_noise_;
  std::vector<double> bias_m_;  // by laser
  std::vector<Piece> pieces_;   // by volley; kept from scan to scan
  std::int64_t rays_ = 0;
};

}  // namespace

std::unique_ptr<Scanner> make_volley_scanner(const LidarConfig& config, BeamTable table,
                                             std::unique_ptr<EchoModel> model, std::unique_ptr<Detector> detector,
                                             ReturnMode returns, std::uint64_t seed) {
  return std::make_unique<VolleyScanner>(config, std::move(table), std::move(model), std::move(detector), returns,
                                         seed);
}

}  // namespace canyon::lidar
