#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/time.h"

/// What real sensors and estimators output. Floor-2 folders meet only here. Truth has records of its own
/// (core/truth.h).
namespace canyon {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// One inertial sample: increments over (t - dt_s, t] in the IMU frame U.
struct ImuSample {
  GpsTime t;
  double dt_s = 0.0;
  Eigen::Vector3d dtheta_U = Eigen::Vector3d::Zero();  ///< integral of the inertial angular rate w_IU_U, rad
  Eigen::Vector3d dv_U = Eigen::Vector3d::Zero();      ///< integral of the specific force f_U, m/s
  bool lost = false;  ///< it did not arrive: the increments are those of the last sample that did, as drivers repeat it
};

enum class GnssSystem : std::uint8_t { kGps = 0, kGlonass, kGalileo, kBeidou, kQzss, kSbas };
char system_letter(GnssSystem system);  ///< RINEX letter: G R E C J S

/// A satellite as RINEX names it: G01, E30, ...
struct SatelliteId {
  GnssSystem system = GnssSystem::kGps;
  std::uint8_t prn = 0;
  auto operator<=>(const SatelliteId&) const = default;
  std::string str() const;
  /// Stable number, for random-stream entities.
  std::uint32_t entity() const { return static_cast<std::uint32_t>(system) * 256u + prn; }
};

/// A further signal of a satellite, of a dual-frequency receiver.
struct GnssSecondSignal {
  int band = 0;  ///< RINEX band digit; 0 = none, and the rest is NaN
  double pseudorange_m = kNaN;
  double doppler_hz = kNaN;
  double carrier_phase_cycles = kNaN;
  double cn0_dbhz = kNaN;
  bool slipped = false;
};

/// One satellite's measurements and all that a tightly coupled filter needs beside them.
struct GnssObservation {
  SatelliteId sv;
  int band = 1;                        ///< RINEX band digit of the signal measured
  double pseudorange_m = kNaN;         ///< as measured: true range + clocks + delays + noise
  double doppler_hz = kNaN;            ///< positive when the range shrinks
  double carrier_phase_cycles = kNaN;  ///< grows with the range; an unknown number of whole cycles is in it
  double cn0_dbhz = kNaN;
  bool slipped =
      false;  ///< the carrier phase does not continue the previous epoch's: lock was lost, or was just gained
  GnssSecondSignal second;
  double sigma_m = kNaN;  ///< 1-sigma the receiver assumes for the corrected pseudorange
  Eigen::Vector3d p_E =
      Eigen::Vector3d::Constant(kNaN);  ///< satellite at transmission, in E of the time of reception (Sagnac applied)
  Eigen::Vector3d v_E = Eigen::Vector3d::Constant(kNaN);
  double clock_m = 0.0;       ///< satellite clock incl. relativity and group delay, times c; added to the pseudorange
  double correction_m = 0.0;  ///< modelled atmosphere or differential correction, subtracted from the pseudorange
  double rate_m_s = kNaN;  ///< rate of the corrected pseudorange by the Doppler shift: range rate + receiver clock rate
  bool used = false;       ///< used in the receiver's own fix

  /// What a solver fits: range + receiver clock + unmodelled errors.
  double corrected_m() const { return pseudorange_m + clock_m - correction_m; }
};

struct GnssEpoch {
  GpsTime t;  ///< receiver's time of reception
  std::vector<GnssObservation> observations;
};

enum class FixStatus : std::uint8_t { kNone = 0, kSingle = 1, kDifferential = 2 };

struct Dop {
  double gdop = kNaN, pdop = kNaN, hdop = kNaN, vdop = kNaN, tdop = kNaN;
};

/// Position fix of the antenna A.
struct GnssFix {
  GpsTime t;
  FixStatus status = FixStatus::kNone;  ///< kNone: geometry or satellites do not allow a fix; `reason` says which
  Eigen::Vector3d p_A_E = Eigen::Vector3d::Constant(kNaN);
  Eigen::Matrix3d covariance_E = Eigen::Matrix3d::Constant(kNaN);           ///< of p_A_E, as the receiver believes, m^2
  Eigen::Vector3d v_A_E = Eigen::Vector3d::Constant(kNaN);                  ///< NaN where the receiver gives none
  Eigen::Matrix3d velocity_covariance_E = Eigen::Matrix3d::Constant(kNaN);  ///< of v_A_E, m^2/s^2
  double clock_m = kNaN;
  Dop dop;
  int satellites = 0;  ///< used in the fix
  std::string reason;  ///< why there is no fix; empty otherwise
};

/// One LIDAR return in the sensor frame L at its own firing time (not deskewed).
struct LidarPoint {
  float x = 0, y = 0, z = 0;  ///< m, in L
  float intensity = 0;        ///< 0..1, calibrated reflectivity as the sensor reports it
  float time_s = 0;           ///< firing time minus scan stamp, <= 0
  std::uint16_t ring = 0;
  std::uint8_t return_index = 0;  ///< 0 = first
};

/// One revolution: rays fired over (t - period_s, t].
struct LidarScan {
  GpsTime t;
  double period_s = 0.0;
  std::vector<LidarPoint> points;
};

/// Pose of `source` in `target` with its covariance (of xi, source frame), as a registration gives it.
struct RelativePose {
  GpsTime source, target;
  Pose X_TS;
  Matrix6d covariance = Matrix6d::Constant(kNaN);
};

/// Pose of B in a map, whose frame is W, with its covariance (of xi, body frame).
struct PoseInMap {
  GpsTime t;
  Pose X_WB;
  Matrix6d covariance = Matrix6d::Constant(kNaN);
};

/// What the encoder of a wheel counted over (t - dt_s, t], and the forward speed that the nominal wheel makes of it.
struct OdometerSample {
  GpsTime t;
  double dt_s = 0.0;
  std::int64_t ticks = 0;  ///< negative in reverse
  double speed_m_s = 0.0;
};
struct BarometerSample {
  GpsTime t;
  double pressure_pa = 0.0;  ///< static pressure
};
struct MagnetometerSample {
  GpsTime t;
  Eigen::Vector3d field_U_t = Eigen::Vector3d::Zero();  ///< magnetic flux density, tesla
};
struct HeadingSample {
  GpsTime t;
  double heading_rad = 0.0;  ///< from true north, clockwise
  double sigma_rad = 0.0;
};

/// The localization filter's answer. Poses in W; the filter itself works in E.
struct NavEstimate {
  GpsTime t;
  Pose X_WB;
  Eigen::Vector3d v_WB_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_U = Eigen::Vector3d::Zero();   ///< rad/s
  Eigen::Vector3d accel_bias_U = Eigen::Vector3d::Zero();  ///< m/s^2
  Matrix6d pose_covariance = Matrix6d::Zero();  ///< of xi = [rotation; translation], right perturbation, body frame
  Eigen::Matrix3d velocity_covariance_W = Eigen::Matrix3d::Zero();
};

/// What autonomy asks of the vehicle; takes effect at the next step.
struct DriveCommand {
  double speed_m_s = 0.0;
  double curvature_1_m = 0.0;  ///< of the rear axle's path, left positive
};

}  // namespace canyon
