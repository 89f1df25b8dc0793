#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/earth/local_frame.h"
#include "canyon/core/messages.h"
#include "canyon/core/result.h"
#include "canyon/core/truth.h"

namespace canyon::inertial {

/// The motion of a body B in W over time, with exact derivatives. One-level interface; the models are in the table
/// below.
class Motion {
 public:
  virtual ~Motion() = default;
  /// Kinematics at a time from the start, 0 <= t_s <= duration_s(). `t` of the result is left 0.
  virtual KinematicState at(double t_s) const = 0;
  /// Infinite for paths in closed form.
  virtual double duration_s() const { return std::numeric_limits<double>::infinity(); }
};

/// A sinusoidal vibration of the IMU against the body, the same in time as on a shaker.
struct Sinusoid {
  double frequency_hz = 50.0;
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  ///< amplitude, along x, y, z of B
  Eigen::Vector3d angle_deg = Eigen::Vector3d::Zero();          ///< amplitude of roll, pitch, yaw
  double phase_deg = 0.0;                                       ///< of both, at the start
};
void visit(FieldVisitor& f, Sinusoid& c);

/// What the IMU does against the body.
struct VibrationConfig {
  std::vector<Sinusoid> sinusoid;
  std::vector<double> psd_hz, psd_g2_per_hz;  ///< one-sided acceleration density, each axis; linear in both logarithms
  std::int64_t psd_lines = 50;
};
void visit(FieldVisitor& f, VibrationConfig& c);

/// Which motion, where. Each path uses the parameters that its line of the table names.
struct MotionConfig {
  std::string path = "stationary";
  double lat_deg = 32.35, lon_deg = -90.88, height_m = 60.0;  ///< origin of W
  double heading_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
  double speed_m_s = 10.0;
  double radius_m = 50.0;
  double length_m = 100.0, width_m = 60.0, period_s = 60.0;
  double climb_m = 0.0, sway_deg = 0.0;
  std::vector<double> profile_s, profile_m_s;
  double cone_deg = 1.0, cone_hz = 10.0;
  std::string file;
  double smoothing_s = 0.0, file_rate_hz = 10.0;
  VibrationConfig vibration;
};
void visit(FieldVisitor& f, MotionConfig& c);

/// A motion with its frame, its first instant and where on the body the IMU sits.
struct PlacedMotion {
  LocalFrame frame;
  GpsTime start{};
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> R_BU{};  ///< axes of the IMU on the body; none: parallel
  std::shared_ptr<const Motion> motion;

  /// Kinematics of the IMU: of its own axes, origin at the lever arm.
  KinematicState imu_at(double t_s) const;
};

/// The documentation of a row names the parameters that it uses.
using MakeMotion = Result<PlacedMotion>(const MotionConfig& config);
ModelTable<MakeMotion> motion_models();

/// The motion that the configuration names, with its vibration; the IMU at the body's origin. Random vibration draws
/// its phases from the streams "imu.vibration.*".
Result<PlacedMotion> make_motion(const MotionConfig& config, std::uint64_t seed);

/// How far the increments of one interval may be from the exact integrals, each component.
struct IncrementAccuracy {
  double dtheta_rad = 0.0, dv_m_s = 0.0;
};

/// Increments of an ideal IMU over (from_s, to_s]: integrals of rate and specific force (inertial/true_increments.h) by
/// adaptive Gauss-Kronrod quadrature of the path's own derivatives. To 1e-12 rad and m/s, or to what rounding leaves of
/// the path's magnitudes where that is more: 50 epsilons of the terms that are summed, and what rounding of the time
/// makes of a fast change. The work is bounded (256 panels of 15 points); a path that turns or shakes too fast for them
/// is integrated less well, and `reached`, if given, says how well. `t` and `dt_s` are those of the stamps, start +
/// from_s and start + to_s rounded to 1 ns. Throws ProgramError if the motion is not finite.
ImuSample motion_increments(const PlacedMotion& placed, double from_s, double to_s,
                            IncrementAccuracy* reached = nullptr);

}  // namespace canyon::inertial
