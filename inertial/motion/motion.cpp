#include "canyon/inertial/motion/motion.h"

#include "canyon/core/units.h"
#include "canyon/inertial/motion/models.h"
#include "canyon/inertial/motion/rigid_motion.h"

namespace canyon::inertial {
namespace {

constexpr ModelRow<MakeMotion> kRows[] = {
    {"stationary", make_stationary, "at rest at W's origin: heading_deg, pitch_deg, roll_deg"},
    {"straight", make_straight,
     "ahead at a speed that goes smoothly through profile_s, profile_m_s, or at speed_m_s: heading_deg"},
    {"circle", make_circle,
     "level, counter-clockwise, nose ahead: radius_m, speed_m_s, heading_deg at the start, roll_deg"},
    {"figure_eight", make_figure_eight,
     "a lying eight, nose ahead: length_m, width_m, period_s, climb_m (height), sway_deg (roll), heading_deg of its "
     "axis"},
    {"coning", make_coning, "classical coning in place, the axis on a cone about the vertical: cone_deg, cone_hz"},
    {"spline", make_spline,
     "smooth through the points of `file`, CSV of t_s,x_m,y_m,z_m and yaw_deg,pitch_deg,roll_deg or nose ahead"},
    {"recorded", make_recorded,
     "a recorded trajectory `file`: .tum, .kitti (file_rate_hz), CSV of poses, or KF-GINS truth; smoothing_s"},
};

}  // namespace

void visit(FieldVisitor& f, Sinusoid& c) {
  f.number("frequency_hz", c.frequency_hz, {1e-3, 1e5}, "frequency");
  f.vector3("acceleration_m_s2", c.acceleration_m_s2, {-1e5, 1e5}, "amplitude along x, y, z of the body");
  f.vector3("angle_deg", c.angle_deg, {-90, 90}, "amplitude of roll, pitch, yaw");
  f.number("phase_deg", c.phase_deg, {-360, 360}, "phase at the start");
}

void visit(FieldVisitor& f, VibrationConfig& c) {
  f.list("sinusoid", c.sinusoid, "sinusoidal vibrations of the IMU against the body");
  f.numbers("psd_hz", c.psd_hz, 0, {1e-3, 1e5}, "frequencies of the random vibration's density");
  f.numbers("psd_g2_per_hz", c.psd_g2_per_hz, 0, {1e-30, 1e6},
            "its one-sided acceleration density there, each axis; linear in both logarithms between");
  f.integer("psd_lines", c.psd_lines, {1, 10000}, "sinusoids per axis it is made of");
}

void visit(FieldVisitor& f, MotionConfig& c) {
  f.choice("path", c.path, model_names(motion_models()), "which motion");
  f.number("lat_deg", c.lat_deg, {-90, 90}, "origin of W, geodetic");
  f.number("lon_deg", c.lon_deg, {-360, 360}, "origin of W");
  f.number("height_m", c.height_m, {-1e4, 1e6}, "origin of W, above the ellipsoid");
  f.number("heading_deg", c.heading_deg, {-360, 360}, "from true north, clockwise");
  f.number("pitch_deg", c.pitch_deg, {-90, 90}, "nose down");
  f.number("roll_deg", c.roll_deg, {-180, 180}, "left side up");
  f.number("speed_m_s", c.speed_m_s, {-1e4, 1e4}, "speed");
  f.number("radius_m", c.radius_m, {1e-3, 1e6}, "radius of the circle");
  f.number("length_m", c.length_m, {1e-3, 1e6}, "of the eight, along its axis");
  f.number("width_m", c.width_m, {1e-3, 1e6}, "of the eight, across its axis");
  f.number("period_s", c.period_s, {1e-3, 1e6}, "one round of the eight");
  f.number("climb_m", c.climb_m, {0, 1e4}, "amplitude of height on the eight, two waves a round");
  f.number("sway_deg", c.sway_deg, {0, 90}, "amplitude of roll on the eight, three waves a round");
  f.numbers("profile_s", c.profile_s, 0, {0, 1e7}, "times of the speed profile");
  f.numbers("profile_m_s", c.profile_m_s, 0, {-1e4, 1e4}, "speeds at those times");
  f.number("cone_deg", c.cone_deg, {0, 179}, "half angle of the coning motion");
  f.number("cone_hz", c.cone_hz, {1e-6, 1e5}, "turns per second of the coning motion");
  f.file("file", c.file, "", "points or trajectory");
  f.number("smoothing_s", c.smoothing_s, {0, 1e5},
           "period of an oscillation of which smoothing leaves half; 0: through every point");
  f.number("file_rate_hz", c.file_rate_hz, {1e-3, 1e5}, "poses per second of a file without times");
  f.group("vibration", c.vibration, "vibration of the IMU against the body");
}

ModelTable<MakeMotion> motion_models() {
  return kRows;
}

LocalFrame frame_of(const MotionConfig& config) {
  return LocalFrame(Geodetic{config.lat_deg * kDegree, config.lon_deg * kDegree, config.height_m});
}

Result<PlacedMotion> make_motion(const MotionConfig& config, std::uint64_t seed) {
  CANYON_TRY(PlacedMotion placed, model_row(motion_models(), config.path).make(config));
  CANYON_TRY(placed.motion, with_vibration(placed.motion, config.vibration, seed));
  return placed;
}

KinematicState PlacedMotion::imu_at(double t_s) const {
  KinematicState mount;
  mount.X_WB.p = lever_arm_m;
  if (R_BU) mount.X_WB.R = *R_BU;
  return compose(motion->at(t_s), mount);
}

}  // namespace canyon::inertial
