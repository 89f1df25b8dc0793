#include "canyon/tests/lidar/registration/trials/trial.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "canyon/core/units.h"
#include "canyon/tests/lidar/lidar_scenes.h"

namespace canyon::lidar::trials {
namespace {

Pose sensor_pose(Draws& draws, double x, double y, double yaw_deg) {
  const double tilt = 0.5 * kDegree;
  return {
      rotation_from({.yaw_rad = yaw_deg * kDegree, .pitch_rad = draws.normal(tilt), .roll_rad = draws.normal(tilt)}),
      {x, y, kHeight_m + draws.normal(0.03)}};
}

std::vector<Eigen::Vector3f> cloud_from(const scene::Scene& scene, const Sensor& sensor, const Pose& X_WL,
                                        std::uint64_t noise) {
  LidarConfig config;
  config.beams = sensor.name;
  config.azimuth_steps = sensor.azimuth_steps;
  config.mount_m.setZero();
  config.range_noise_m = kRangeNoise_m;
  const auto scanner = *make_scanner(config, noise);
  return testing::positions(scanner->scan(0, testing::kStart, testing::standing(X_WL), scene::SceneAt(scene)).scan);
}

/// Whether a step of the place's period leads from the truth to where the prior reaches.
bool repeats_within(const PosePrior& prior, const Pose& X_WT, const Pose& X_WS, double period_m) {
  bool within = false;
  for (const double step : {-period_m, period_m}) {
    Pose moved = X_WS;
    moved.p.x() += step;
    const Vector6d xi = (prior.X_TS.inverse() * (X_WT.inverse() * moved)).log();
    within |= xi.dot(prior.covariance.ldlt().solve(xi)) < 9.0;
  }
  return within;
}

}  // namespace

Vector6d draw_guess(Draws& draws, const Ring& ring) {
  const double distance_m = draws.uniform(ring.from_m, ring.to_m), azimuth = draws.uniform(-kPi, kPi);
  Vector6d xi;
  xi << draws.normal(kGuessTilt_deg * kDegree), draws.normal(kGuessTilt_deg * kDegree),
      draws.side() * draws.uniform(ring.from_deg, ring.to_deg) * kDegree, distance_m * std::cos(azimuth),
      distance_m * std::sin(azimuth), draws.normal(kGuessUp_m);
  return xi;
}

Trial make_trial(const Place& place, const Sensor& sensor, const Ring& ring, std::uint64_t seed, std::uint64_t number) {
  const std::string stream = std::string("trials.") + place.name + '.' + sensor.name + '.' + ring.name;
  Draws where(seed, stream + ".poses", number), off(seed, stream + ".guess", number);
  const double x = where.uniform(-place.half_x_m, place.half_x_m), y = where.uniform(-place.half_y_m, place.half_y_m),
               yaw_deg = where.uniform(-180, 180);
  const Pose X_WT = sensor_pose(where, x, y, yaw_deg);
  const double way_m = where.uniform(0, kApart_m), towards = where.uniform(-0.3, 0.3) + (where.side() < 0 ? kPi : 0);
  const Pose X_WS = sensor_pose(where, x + way_m * std::cos(towards), y + way_m * std::sin(towards),
                                yaw_deg + where.uniform(-kApart_deg, kApart_deg));
  Trial trial;
  const auto scene_at = [&](bool later) {
    Draws draws(seed, stream + ".place", number);
    return place.build(draws, later);
  };
  const std::uint64_t noise = RandomStream(seed, stream + ".noise").key() + 2 * number;
  trial.target = cloud_from(scene::Scene(scene_at(false)), sensor, X_WT, noise);
  trial.source = cloud_from(scene::Scene(scene_at(true)), sensor, X_WS, noise + 1);
  trial.truth = X_WT.inverse() * X_WS;
  trial.prior = {trial.truth * Pose::exp(-draw_guess(off, ring)), ring.law()};
  const Eigen::Matrix3d R_SW = X_WS.R.conjugate().toRotationMatrix();
  const auto open = [&](const Eigen::Vector3d& turn, const Eigen::Vector3d& shift) {
    Vector6d v;
    v << R_SW * turn, R_SW * shift;
    trial.open.push_back(v);
  };
  if (place.open_x) open(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  if (place.open_turn) open(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitY());
  if (place.open_turn) open(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero());
  trial.ambiguous = place.open_turn || (place.period_m > 0 && repeats_within(trial.prior, X_WT, X_WS, place.period_m));
  return trial;
}

}  // namespace canyon::lidar::trials
