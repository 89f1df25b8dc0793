#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "canyon/core/earth/local_frame.h"
#include "canyon/core/motion/true_motion.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/scene/scene.h"

namespace canyon::mission {

/// The sensors of one run beside IMU and receiver, as far as it has them, on its true motion. Barometer and
/// magnetometer sit in the IMU's box, in its place and along its axes R_BU; the odometer's wheel where its
/// configuration says. Samples count from 0.
class Aiding {
 public:
  Aiding(const AidingSensors& which, const MissionConfig& config, const scene::Scene& scene,
         const Eigen::Quaterniond& R_BU, GpsTime start);

  /// What the wheel counted since the last call, or the start, up to t; `motion` must reach back so far.
  inertial::Odometer::Reading count(std::int64_t k, const TrueMotion& motion, GpsTime t);
  inertial::Barometer::Reading pressure(std::int64_t k, const KinematicState& truth);
  inertial::Magnetometer::Reading field(std::int64_t k, const KinematicState& truth) const;

  /// From now on what each sample draws anew is another draw.
  void draw_anew(std::uint64_t noise_seed);

  /// From when on the true motion is still needed, if all else needs it from t on.
  GpsTime needs_from(GpsTime t) const { return odometer_ ? std::min(t, counted_until_) : t; }

 private:
  LocalFrame frame_;
  Pose X_BU_;
  std::optional<inertial::Odometer> odometer_;
  GpsTime counted_until_;
  std::optional<inertial::Barometer> barometer_;
  std::optional<inertial::Magnetometer> magnetometer_;
};

}  // namespace canyon::mission
