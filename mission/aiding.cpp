#include "canyon/mission/aiding.h"

#include <algorithm>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/earth/geoid.h"

namespace canyon::mission {

namespace {

/// Where none is stated, that of the scene's heights, else the geoid's at the scene.
inertial::BarometerConfig placed(inertial::BarometerConfig config, const scene::Scene& scene) {
  if (config.undulation_m) return config;
  const double of_scene_m = scene.parts().undulation_m;
  config.undulation_m = of_scene_m != 0.0 ? of_scene_m : geoid_height(scene.frame().origin()).undulation_m;
  return config;
}

}  // namespace

Aiding::Aiding(const AidingSensors& which, const MissionConfig& config, const scene::Scene& scene,
               const Eigen::Quaterniond& R_BU, GpsTime start)
    : frame_(scene.frame()), X_BU_{R_BU, config.imu.lever_arm_m}, counted_until_(start) {
  const auto seed = static_cast<std::uint64_t>(config.run.seed);
  if (which.odometer) odometer_.emplace(config.odometer, seed);
  if (which.barometer) barometer_.emplace(placed(config.barometer, scene), seed);
  if (which.magnetometer) magnetometer_.emplace(config.magnetometer, seed);
}

inertial::Odometer::Reading Aiding::count(std::int64_t k, const TrueMotion& motion, GpsTime t) {
  CANYON_CHECK(odometer_.has_value(), "no odometer");
  // Simpson's rule with nodes at most half of a master step (10 ms) apart, four intervals at least.
  constexpr std::int64_t kPiece_ns = 10'000'000;
  const std::int64_t span_ns = t.ns - counted_until_.ns;
  const std::int64_t intervals = 2 * std::max<std::int64_t>(2, (span_ns + kPiece_ns - 1) / kPiece_ns);
  std::vector<KinematicState> nodes;
  for (std::int64_t i = 0; i <= intervals; ++i) {
    GpsTime at = counted_until_;
    at.ns += span_ns * i / intervals;
    nodes.push_back(motion.at(at));
  }
  counted_until_ = t;
  return odometer_->sample(k, nodes);
}

inertial::Barometer::Reading Aiding::pressure(std::int64_t k, const KinematicState& truth) {
  CANYON_CHECK(barometer_.has_value(), "no barometer");
  return barometer_->sample(k, truth.t, frame_.to_geodetic(truth.X_WB * X_BU_.p).h_m);
}

inertial::Magnetometer::Reading Aiding::field(std::int64_t k, const KinematicState& truth) const {
  CANYON_CHECK(magnetometer_.has_value(), "no magnetometer");
  return magnetometer_->sample(k, truth.t, truth.X_WB.R * X_BU_.R);
}

void Aiding::draw_anew(std::uint64_t noise_seed) {
  if (odometer_) odometer_->draw_anew(noise_seed);
  if (barometer_) barometer_->draw_anew(noise_seed);
  if (magnetometer_) magnetometer_->draw_anew(noise_seed);
}

}  // namespace canyon::mission
