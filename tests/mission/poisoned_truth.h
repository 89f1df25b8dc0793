#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "canyon/gnss/sensor/sensor.h"
#include "canyon/lidar/scanner.h"
#include "canyon/mission/run.h"

namespace canyon::mission::testing {

inline constexpr double kPoison_m = 1e5;

/// A receiver whose truth is poisoned; what it tells is as it was.
class PoisonedReceiver final : public gnss::GnssSensor {
 public:
  explicit PoisonedReceiver(std::unique_ptr<gnss::GnssSensor> sensor) : sensor_(std::move(sensor)) {}
  gnss::GnssOutput measure(std::int64_t index, GpsTime t, const Eigen::Vector3d& p, const Eigen::Vector3d& v,
                           const scene::SceneAt& scene) override {
    gnss::GnssOutput output = sensor_->measure(index, t, p, v, scene);
    for (GnssObservationTruth& satellite : output.truth.satellites) {
      satellite.multipath_m = kPoison_m;
      satellite.noise_m = satellite.ephemeris_m = satellite.ionosphere_m = satellite.troposphere_m = -kPoison_m;
      satellite.range_m *= 0.5;
      satellite.range_rate_m_s += 100.0;
      satellite.line_of_sight = !satellite.line_of_sight;
      satellite.tracked = !satellite.tracked;
      satellite.reflections = 7;
    }
    output.truth.p_A_E += Eigen::Vector3d(300.0, -200.0, 100.0);
    output.truth.v_A_E *= -1.0;
    output.truth.receiver_clock_m += 1e3;
    std::reverse(output.truth.satellites.begin(), output.truth.satellites.end());
    return output;
  }
  gnss::GnssCounters counters() const override { return sensor_->counters(); }
  bool has_satellites() const override { return sensor_->has_satellites(); }

 private:
  std::unique_ptr<gnss::GnssSensor> sensor_;
};

/// A LIDAR whose truth is poisoned: every return has been off the scene's first thing, a metre away.
class PoisonedScanner final : public lidar::Scanner {
 public:
  PoisonedScanner(std::unique_ptr<lidar::Scanner> scanner, int& poisoned)
      : scanner_(std::move(scanner)), poisoned_(poisoned) {}
  void scan(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
            const InstancesAt& moving, lidar::LidarOutput& out) override {
    scanner_->scan(index, t, truth, scene, moving, out);
    for (LidarPointTruth& point : out.truth) {
      poisoned_ += point.object != 0 ? 1 : 0;
      point = {.range_m = 1.0f, .cos_incidence = 1.0f, .material = 0, .object = 0};
    }
  }
  void true_ranges(std::int64_t index, GpsTime t, const Trajectory& truth, const scene::SceneAt& scene,
                   std::vector<float>& out) override {
    scanner_->true_ranges(index, t, truth, scene, out);
  }
  double reach_s(std::int64_t index) const override { return scanner_->reach_s(index); }
  void keep(const lidar::KeptRoom* room) override { scanner_->keep(room); }
  std::int64_t rays() const override { return scanner_->rays(); }

 private:
  std::unique_ptr<lidar::Scanner> scanner_;
  int& poisoned_;  ///< returns that were off something else
};

/// Gives a run that receiver and that LIDAR, with the draws of its own; `returns`, which must outlive it, counts those
/// that were poisoned.
inline void poison(const MissionConfig& config, const PreparedMission& mission, RunParts& parts, int& returns) {
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  auto sensor =
      gnss::make_gnss_sensor(config.gnss, seed, mission.start, mission.start + mission.time_limit_s, *mission.scene);
  ASSERT_TRUE(sensor.ok()) << sensor.error().str();
  parts.receiver = std::make_unique<PoisonedReceiver>(*std::move(sensor));
  auto scanner = lidar::make_scanner(config.lidar, seed);
  ASSERT_TRUE(scanner.ok()) << scanner.error().str();
  parts.scanner = std::make_unique<PoisonedScanner>(*std::move(scanner), returns);
}

}  // namespace canyon::mission::testing
