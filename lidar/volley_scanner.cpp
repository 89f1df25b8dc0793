#include "canyon/lidar/volley_scanner.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <span>

#include "canyon/core/check.h"
#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/beam/weather.h"
#include "canyon/lidar/ego_mask.h"
#include "canyon/lidar/receiver/crosstalk.h"
#include "canyon/lidar/receiver/sensor_report.h"
#include "canyon/lidar/sweep_motion.h"

namespace canyon::lidar {
namespace {

/// Noise and bias may bring a surface just beyond the limit into view: eight standard deviations of each.
double reach_m(const LidarConfig& config, const Detector& detector) {
  return config.report.max_range_m +
         8.0 * (config.range_noise_m + config.report.range_bias_m + detector.weakest_edge_m());
}

class VolleyScanner final : public Scanner {
 public:
  VolleyScanner(const LidarConfig& config, BeamTable table, std::unique_ptr<EchoModel> model,
                std::unique_ptr<Detector> detector, std::uint64_t seed)
      : config_(config),
        period_s_(1.0 / config.rate_hz),
        reach_m_(reach_m(config, *detector)),
        X_BL_(sensor_in_body(config)),
        pattern_(std::move(table), config.rate_hz, static_cast<std::size_t>(config.azimuth_steps)),
        model_(std::move(model)),
        detector_(std::move(detector)),
        weather_(config, seed),
        crosstalk_(config, seed),
        report_(config.report, config.signal, pattern_, seed),
        ego_(config.ego, X_BL_),
        angle_noise_(seed, "lidar.angle") {}

  using Scanner::scan;
  using Scanner::true_ranges;

  void scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
            const InstancesAt& moving, LidarOutput& out) override {
    CANYON_CHECK(index >= 0, "index = ", index);
    out.scan.t = t;
    out.scan.period_s = period_s_;
    if (config_.blinded) {
      out.scan.points.clear();
      out.truth.clear();
      return;
    }
    const FiringPattern::Sweep sweep = pattern_.sweep(index);
    const Eigen::Vector3d origin_W = ray_origin(truth, scene);
    const SweepMotion motion = motion_of(t, truth, sweep, origin_W);
    const Surfaces surfaces(scene, config_.wavelength_nm, config_.signal.reflection, config_.texture);
    const std::size_t volleys = volleys_of(sweep);
    const std::size_t most = sweep.cycles * pattern_.lasers() * report_.most_returns();
    out.scan.points.resize(most);
    out.truth.resize(most);
    const auto write = [&](const VolleyReturns& returns, std::size_t first, std::size_t count) {
      report_.write(returns, std::span(out.scan.points).subspan(first, count),
                    std::span(out.truth).subspan(first, count));
    };
    // Where a volley's returns go in the output is known once those before it are counted. Threads take volleys in
    // order. One that comes in its turn is written at once, while its returns are still in the cache; one that comes
    // early waits in a place of its own for the thread that fills the gap. So the result does not depend on the number
    // of threads.
    if (returns_.size() < volleys) returns_.resize(volleys);
    std::vector<char> waits(volleys, 0);
    std::atomic<std::size_t> next = 0;
    std::size_t turn = 0, written = 0;
    std::mutex mutex;
    parallel_for(std::min(static_cast<std::size_t>(threads()), volleys), 1, [&](std::size_t, std::size_t) {
      thread_local VolleyReturns returns;
      for (std::size_t v = next++; v < volleys; v = next++) {
        run_chain(sweep, v, motion, origin_W, scene, moving, surfaces, returns);
        std::size_t first = 0, first_after = 0, end_turn = 0;
        {
          const std::lock_guard lock(mutex);
          if (turn != v || most == 0) {
            std::swap(returns, returns_[v]);
            waits[v] = 1;
            continue;
          }
          first = written;
          first_after = written += returns.total;
          for (++turn; turn < volleys && waits[turn] != 0; ++turn) written += returns_[turn].total;
          end_turn = turn;
        }
        write(returns, first, returns.total);
        for (std::size_t after = v + 1; after < end_turn; ++after) {
          write(returns_[after], first_after, returns_[after].total);
          first_after += returns_[after].total;
        }
      }
    });
    if (most == 0) {  // nobody knows how many returns there are before all are counted
      std::vector<std::size_t> first(volleys + 1, 0);
      for (std::size_t v = 0; v < volleys; ++v) first[v + 1] = first[v] + returns_[v].total;
      written = first[volleys];
      out.scan.points.resize(written);
      out.truth.resize(written);
      parallel_for(volleys, 1, [&](std::size_t v, std::size_t) { write(returns_[v], first[v], returns_[v].total); });
    }
    out.scan.points.resize(written);
    out.truth.resize(written);
    rays_ += static_cast<std::int64_t>(sweep.cycles * pattern_.lasers() * model_->rays_per_shot());
    rays_ -= not_fired_.exchange(0);
  }

  void keep(const KeptRoom* room) override {
    kept_.reset();
    if (room != nullptr && follows_shots_alone(config_)) kept_ = *room;
  }

  void true_ranges(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
                   std::vector<float>& out) override {
    const FiringPattern::Sweep sweep = pattern_.sweep(index);
    const Eigen::Vector3d origin_W = ray_origin(truth, scene);
    const SweepMotion motion = motion_of(t, truth, sweep, origin_W);
    out.resize(pattern_.lasers() * sweep.cycles);
    // Laser by laser over many cycles: long runs of neighbouring rays.
    constexpr std::size_t kPackets = 16, kCycles = kPackets * Volley::kLanes;
    const auto max_m = static_cast<float>(config_.report.max_range_m);
    const bool plain = !(config_.angle_noise_deg > 0) && !ego_.any();
    parallel_for((sweep.cycles + kCycles - 1) / kCycles, 1, [&](std::size_t stripe, std::size_t) {
      const std::size_t first = stripe * kCycles, cycles = std::min(kCycles, sweep.cycles - first);
      const std::size_t packets = (cycles + Volley::kLanes - 1) / Volley::kLanes;
      std::array<PlacementPacket, kPackets> placements;
      std::array<scene::RayPacket, kPackets> rays;
      std::array<scene::HitPacket, kPackets> hits;
      AimPacket aim;
      for_lasers(sweep, motion, first, std::span(placements).first(packets), [&](std::size_t laser, float late_s) {
        if (plain) {
          pattern_.fire(sweep, laser, first, std::span(placements).first(packets), late_s, max_m, rays.data());
          std::fill(rays[packets - 1].max_m + (cycles - 1) % Volley::kLanes + 1,
                    rays[packets - 1].max_m + Volley::kLanes, -1.0f);
        } else {
          for (std::size_t k = 0; k < packets; ++k)
            lay_out(sweep, laser, first + k * Volley::kLanes, placements[k], late_s, max_m, aim, rays[k]);
        }
        scene.trace(std::span(rays).first(packets), std::span(hits).first(packets), origin_W);
        float* ring = out.data() + laser * sweep.cycles + first;
        for (std::size_t c = 0; c < cycles; c += Volley::kLanes) {
          const float* range_m = hits[c / Volley::kLanes].range_m;
          if (c + Volley::kLanes <= cycles)  // a copy of known size takes no call
            std::copy_n(range_m, Volley::kLanes, ring + c);
          else
            std::copy_n(range_m, cycles - c, ring + c);
        }
      });
    });
    rays_ += static_cast<std::int64_t>(out.size());
  }

  double reach_s(std::int64_t index) const override { return config_.latency_s - first_s(pattern_.sweep(index)); }
  std::int64_t rays() const override { return rays_; }

 private:
  static std::size_t volleys_of(const FiringPattern::Sweep& sweep) {
    return (sweep.cycles + Volley::kCycles - 1) / Volley::kCycles;
  }

  static Eigen::Vector3d ray_origin(const Trajectory& truth, const scene::SceneAt& scene) {
    return truth.empty() ? Eigen::Vector3d::Zero() : scene.packet_origin(truth.poses().back().X_WB.p);
  }

  /// When the sweep begins, after its stamp less the latency.
  double first_s(const FiringPattern::Sweep& sweep) const { return std::min(-period_s_, sweep.start_s); }

  /// The sensor's motion in W moved to origin_W.
  SweepMotion motion_of(GpsTime t, const Trajectory& truth, const FiringPattern::Sweep& sweep,
                        const Eigen::Vector3d& origin_W) const {
    const double first = first_s(sweep);
    const Pose X_RW{Eigen::Quaterniond::Identity(), -origin_W};
    SweepMotion motion(truth, t - config_.latency_s, first, 0.0, X_RW, X_BL_);
    CANYON_CHECK(motion.covers(first) && motion.covers(0.0), "the true motion does not cover the sweep that ends at ",
                 (t - config_.latency_s).iso());
    return motion;
  }

  /// Calls visit(laser, late_s) for each laser in firing order: it fires late_s after the times of `placements`, which
  /// are those of consecutive cycles from `first` on, sixteen to a packet.
  template <class Visit>
  void for_lasers(const FiringPattern::Sweep& sweep, const SweepMotion& motion, std::size_t first,
                  std::span<PlacementPacket> placements, const Visit& visit) const {
    // Shots of one cycle are placed from one place each, those fired late in a long cycle from one of their own.
    constexpr double kSamePlace_s = 100e-6;
    double placed_s = -1.0;
    std::size_t hint = 0;
    for (const std::size_t laser : pattern_.firing_order()) {
      const double firing_s = pattern_.table().beams[laser].firing_s;
      if (placed_s < 0 || firing_s - placed_s > kSamePlace_s) {
        placed_s = firing_s;
        for (std::size_t k = 0; k < placements.size(); ++k)
          motion.placements(first_s(sweep, first + k * Volley::kLanes) + placed_s, pattern_.step_s(), hint,
                            placements[k]);
      }
      visit(laser, static_cast<float>(firing_s - placed_s));
    }
  }
  double first_s(const FiringPattern::Sweep& sweep, std::size_t cycle) const {
    return sweep.start_s + static_cast<double>(cycle) * pattern_.step_s();
  }

  /// Aims and rays of one laser in sixteen cycles from `first` on. Those beyond the sweep are not traced.
  void lay_out(const FiringPattern::Sweep& sweep, std::size_t laser, std::size_t first,
               const PlacementPacket& placements, float late_s, float reach_m, AimPacket& aim,
               scene::RayPacket& rays) const {
    const std::size_t left = first < sweep.cycles ? sweep.cycles - first : 0;
    if (left == 0) {
      rays = {};
    } else {
      pattern_.aim(sweep, laser, first, aim);
      if (config_.angle_noise_deg > 0) {
        AimPacket shaken = aim;
        shake(laser, sweep.first_cycle + first, shaken);
        place_shots(shaken, placements, late_s, reach_m, rays);
      } else {
        place_shots(aim, placements, late_s, reach_m, rays);
      }
      if (ego_.any()) ego_.hide(aim, rays);
    }
    for (std::size_t i = left; i < Volley::kLanes; ++i) rays.max_m[i] = -1.0f;
  }

  /// Lays out the rays of volley v.
  void fire(const FiringPattern::Sweep& sweep, std::size_t v, const SweepMotion& motion, Volley& volley) const {
    volley.lasers = pattern_.lasers();
    volley.first_cycle = v * Volley::kCycles;
    volley.cycles = std::min(Volley::kCycles, sweep.cycles - volley.first_cycle);
    volley.first_draw = sweep.first_cycle + volley.first_cycle;
    volley.first_s = first_s(sweep, volley.first_cycle);
    volley.step_s = pattern_.step_s();
    volley.aims.resize(volley.packets());
    volley.rays.resize(volley.packets());
    for_lasers(sweep, motion, volley.first_cycle, volley.placements, [&](std::size_t laser, float late_s) {
      for (std::size_t k = 0; k < Volley::kPacketsPerLaser; ++k) {
        const std::size_t packet = laser * Volley::kPacketsPerLaser + k;
        lay_out(sweep, laser, volley.first_cycle + k * Volley::kLanes, volley.placements[k], late_s,
                static_cast<float>(reach_m_), volley.aims[packet], volley.rays[packet]);
        if (kept_) shorten(*kept_, volley.aims[packet], volley.rays[packet]);
      }
    });
  }

  /// Rays end where no return from beyond is kept; those that would meet nothing before are not fired.
  void shorten(const KeptRoom& room, const AimPacket& aim, scene::RayPacket& rays) const {
    // Heights change by as much as B's axis turns, times the distance; origins of shots lie within 0.2 m of L's.
    constexpr double kOrigin_m = 0.2;
    const double arm_m = X_BL_.p.norm() + kOrigin_m;
    const double slack_m = room.moved_m + room.turned_rad * arm_m + kOrigin_m;
    const double noise_m = 10.0 * (config_.range_noise_m + config_.report.range_bias_m + detector_->weakest_edge_m()) +
                           detector_->most_short_m() + config_.report.range_quantum_m;
    const Eigen::Vector3d up_L = X_BL_.R.conjugate() * Eigen::Vector3d::UnitZ();
    std::int64_t not_fired = 0;
    for (std::size_t i = 0; i < Volley::kLanes; ++i) {
      if (!(rays.max_m[i] >= 0)) continue;
      const double rise = up_L.x() * static_cast<double>(aim.direction_x[i]) +
                          up_L.y() * static_cast<double>(aim.direction_y[i]) +
                          up_L.z() * static_cast<double>(aim.direction_z[i]);
      double reach_m = room.reach_m + arm_m + room.moved_m;
      if (rise > room.turned_rad)
        reach_m = std::min(reach_m, (room.high_m - X_BL_.p.z() + slack_m) / (rise - room.turned_rad));
      if (-rise > room.turned_rad)
        reach_m = std::min(reach_m, (X_BL_.p.z() - room.low_m + slack_m) / (-rise - room.turned_rad));
      reach_m += noise_m;
      const bool too_near = reach_m < config_.report.min_range_m - noise_m;
      const bool empty = rise >= 0.0 && reach_m + arm_m < room.clear_m &&
                         room.above_ground_m - kOrigin_m > reach_m * (room.ground_rise - rise);
      if (too_near || empty) {
        rays.max_m[i] = -1.0f;
        ++not_fired;
      } else {
        rays.max_m[i] = std::min(rays.max_m[i], static_cast<float>(reach_m));
      }
    }
    if (not_fired > 0) not_fired_ += not_fired;
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
                 const Eigen::Vector3d& origin_W, const scene::SceneAt& scene, const InstancesAt& moving,
                 const Surfaces& surfaces, VolleyReturns& out) const {
    thread_local Volley volley;
    volley.origin_W = origin_W;
    thread_local Echoes echoes;
    fire(sweep, v, motion, volley);
    if (moving) {
      scene::SceneAt then = scene;
      then.set_instances(
          moving(volley.first_s + 0.5 * static_cast<double>(volley.cycles) * volley.step_s - config_.latency_s));
      model_->trace(volley, then, Surfaces(then, config_.wavelength_nm, config_.signal.reflection, config_.texture),
                    echoes);
    } else {
      model_->trace(volley, scene, surfaces, echoes);
    }
    weather_.apply(volley, echoes);
    crosstalk_.apply(volley, echoes);
    detector_->detect(volley, echoes);
    report_.choose(volley, echoes, out);
  }

  LidarConfig config_;
  double period_s_, reach_m_;
  Pose X_BL_;
  FiringPattern pattern_;
  std::unique_ptr<EchoModel> model_;
  std::unique_ptr<Detector> detector_;
  Weather weather_;
  Crosstalk crosstalk_;
  SensorReport report_;
  EgoMask ego_;
  RandomStream angle_noise_;
  std::vector<VolleyReturns> returns_;  // by volley; kept from scan to scan
  std::int64_t rays_ = 0;
  std::optional<KeptRoom> kept_;
  mutable std::atomic<std::int64_t> not_fired_ = 0;  // of the present scan
};

}  // namespace

std::unique_ptr<Scanner> make_volley_scanner(const LidarConfig& config, BeamTable table,
                                             std::unique_ptr<EchoModel> model, std::unique_ptr<Detector> detector,
                                             std::uint64_t seed) {
  return std::make_unique<VolleyScanner>(config, std::move(table), std::move(model), std::move(detector), seed);
}

}  // namespace canyon::lidar
