// Where a recording starts, and what is said of it: in motion by velocities that are stated or come of places, with
// what stands where nobody says otherwise; and what is no start.
#include <cmath>
#include <string>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/alignment/alignment.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/drawn_numbers.h"
#include "canyon/fusion/stress/parts/subjects.h"

namespace canyon::fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

Result<Aligned> start_by(const std::string& row, const std::string& keys, const AlignmentInputs& inputs) {
  const auto& found = model_row(alignments(), row);
  ModelParameters own;
  if (found.parameters != nullptr) found.parameters(own);
  const auto node = ConfigNode::parse(keys, "stress");
  CANYON_CHECK(node && read_fields(&*node, "start", [&own](FieldVisitor& f) { own.visit_all(f); }).ok(), keys);
  return found.make(own, inputs);
}

const Vector3d kUnit_B(0.4, -0.3, 0.8), kAerial_B(-1.1, 0.2, 1.9);

/// A vehicle that speeds up evenly along its heading, level, from rest.
struct SpeedingUp {
  static constexpr double kPush_m_s2 = 1.6;
  double heading_rad;
  NavState start = levelled({48.0 * kDegree, 11.0 * kDegree, 400.0}, heading_rad, {0.0, 0.0, 1.0});
  GpsTime t0 = GpsTime::from_week_sow(1600, 500.0);
  Vector3d along_E = start.R_EU * Vector3d::UnitX();

  std::vector<ImuSample> imu(double seconds) const {
    std::vector<ImuSample> out;
    for (std::int64_t k = 0; k < std::llround(100.0 * seconds); ++k) {
      ImuSample s;
      s.t = tick(t0, k + 1, 100.0), s.dt_s = 0.01;
      s.dtheta_U = 0.01 * (start.R_EU.conjugate() * earth_rate_E());
      s.dv_U = 0.01 * (start.R_EU.conjugate() * (kPush_m_s2 * along_E - gravity_E(start.p_EU_E)));
      out.push_back(s);
    }
    return out;
  }
  GnssFix fix(double t, double sigma_m, double sigma_m_s) const {
    GnssFix f;
    f.t = t0 + t, f.status = FixStatus::kSingle;
    f.p_A_E = start.p_EU_E + 0.5 * kPush_m_s2 * t * t * along_E + start.R_EU * (kAerial_B - kUnit_B);
    f.covariance_E =
        Vector3d(0.5, 1.0, 0.8).cwiseAbs2().asDiagonal() * Matrix3d(sigma_m * sigma_m * Matrix3d::Identity());
    if (sigma_m_s == 0.0) return f;
    f.v_A_E = kPush_m_s2 * t * along_E;
    if (sigma_m_s > 0.0)
      f.velocity_covariance_E =
          Vector3d(0.7, 0.2, 1.0).cwiseAbs2().asDiagonal() * Matrix3d(sigma_m_s * sigma_m_s * Matrix3d::Identity());
    return f;
  }
};

GnssFix silent_at(GpsTime t) {
  GnssFix out;
  out.t = t;
  return out;
}

ImuNoise starting_noise() {
  ImuNoise n;
  n.gyro = {.white_per_sqrt_hz = 1e-4, .turn_on_bias_sigma = 3e-4, .in_run_bias_sigma = 4e-4};
  n.accel = {.white_per_sqrt_hz = 1e-2, .turn_on_bias_sigma = 0.06, .in_run_bias_sigma = 0.08};
  return n;
}

/// Fixes each second that state their velocities, well, badly or not at all how well; or places alone, of which the
/// velocity between two is that of the middle: where it starts, which way round and how fast, and each sigma by its
/// formula.
StressFigure speeding_up() {
  Looks looks;
  const ImuNoise noise = starting_noise();
  const double gyro_bias = 5e-4, accel_bias = 0.1, arm = (kUnit_B - kAerial_B).norm();
  for (const double heading : {0.3, 2.9, -1.2}) {
    const SpeedingUp drive{heading};
    const auto imu = drive.imu(9.0);
    struct Row {
      const char* keys;
      double sigma_m_s;  // 0: none is stated, below: of unknown quality
      double at_s, before_s, slip_deg;
    };
    for (const Row& row :
         {Row{"", 0.05, 2.0, 1.0, 2.0}, Row{"in_motion_speed_m_s = 6\nin_motion_slip_deg = 5", 0.05, 4.0, 2.0, 5.0},
          Row{"in_motion_speed_m_s = 6\nin_motion_level_s = 3", 0.05, 4.0, 1.0, 2.0},
          Row{"in_motion_speed_m_s = 6", -1.0, 4.0, 2.0, 2.0}, Row{"in_motion_speed_m_s = 6", 0.0, 5.0, 2.5, 2.0}}) {
      std::vector<GnssFix> fixes;
      for (int k = 1; k <= 8; ++k) fixes.push_back(drive.fix(k, 0.3, row.sigma_m_s));
      fixes.insert(fixes.begin() + 1, silent_at(drive.t0 + 1.5));  // none, and one that is no number
      fixes.insert(fixes.begin() + 1, drive.fix(1.2, kInfinity, row.sigma_m_s));
      const auto found =
          start_by("in_motion", row.keys,
                   {.imu = imu, .fixes = fixes, .noise = noise, .lever_U_B = kUnit_B, .lever_A_B = kAerial_B});
      if (!found) return {kInfinity, 1.0};
      looks.near(found->nav.t - drive.t0, row.at_s, 1e-9);
      // The force is that of a place some metres on, and Coriolis' part of it is left out: 1e-3 m/s^2 of 9.8.
      looks.near(so3_log(drive.start.R_EU.conjugate() * found->nav.R_EU).norm(), 0.0, 3e-4);
      const double way = 0.5 * 1.6 * row.at_s * row.at_s;
      looks.near((found->nav.p_EU_E - drive.start.p_EU_E - way * drive.along_E).norm(), 0.0, 3e-4 * arm + 1e-8);
      looks.near((found->nav.v_EU_E - 1.6 * row.at_s * drive.along_E).norm(), 0.0, 1e-7);
      // Of places of 0.3 m each a second: their velocity is that half a second before.
      const double sigma = row.sigma_m_s > 0.0   ? row.sigma_m_s
                           : row.sigma_m_s < 0.0 ? 0.2
                                                 : 0.3 * std::sqrt(2.0),
                   late_s = row.sigma_m_s == 0.0 ? 0.5 : 0.0;
      const double between = row.at_s - late_s - row.before_s, a_sigma = sigma * std::sqrt(2.0) / between,
                   g = gravity_E(drive.start.p_EU_E).norm();
      const double tilt =
          std::sqrt(std::pow(a_sigma / g, 2) + std::pow(accel_bias / g, 2) + std::pow(gyro_bias * between, 2));
      looks.near(found->tilt_rad / tilt, 1.0, 1e-6);
      looks.near(found->heading_rad / std::hypot(sigma / (1.6 * (row.at_s - late_s)), row.slip_deg * kDegree), 1.0,
                 1e-5);
      looks.near(found->position_m / (0.3 + tilt * arm), 1.0, 1e-6);
      looks.near(found->velocity_m_s / std::hypot(sigma, a_sigma * late_s), 1.0, 1e-6);
    }
  }
  return looks.figure();
}

/// What is no start: nothing fast enough, places too far apart, forces that are missing, an antenna that moves at rest,
/// no fix, a latitude beyond the pole. Each refused; and the sound ones are not.
StressFigure no_starts() {
  int passed = 0;
  const SpeedingUp drive{0.5};
  const auto imu = drive.imu(9.0);
  const auto begun = [&](const std::string& row, const std::string& keys, const std::vector<GnssFix>& fixes,
                         std::span<const ImuSample> samples) {
    return start_by(row, keys,
                    {.imu = samples,
                     .fixes = fixes,
                     .noise = starting_noise(),
                     .lever_U_B = kUnit_B,
                     .lever_A_B = kAerial_B})
                   .ok()
               ? 1
               : 0;
  };
  std::vector<GnssFix> fixes, sparse, still;
  for (int k = 1; k <= 8; ++k) {
    fixes.push_back(drive.fix(k, 0.3, 0.05));
    still.push_back(fixes.back());
    still.back().p_A_E = drive.start.p_EU_E + Vector3d(0.2 * k, 0.0, 0.0);
  }
  for (int k = 0; k <= 3; ++k) sparse.push_back(drive.fix(2.6 * k, 0.3, 0.0));
  passed += 1 - begun("in_motion", "", fixes, imu);
  passed += begun("in_motion", "in_motion_speed_m_s = 13", fixes, imu);  // 12.8 at most
  passed += begun("in_motion", "", sparse, imu) + begun("in_motion", "", {}, imu);
  passed += begun("in_motion", "", {fixes[5]}, imu);                                  // one alone changes nothing
  passed += begun("in_motion", "", {fixes[0], fixes[1]}, std::span(imu).first(150));  // beyond the log
  std::vector<ImuSample> none = imu;
  for (ImuSample& s : none) s.dv_U.setZero();
  passed += begun("in_motion", "", fixes, none);
  // The antenna may move by a metre and six sigma.
  passed += 1 - begun("static", "static_s = 5", still, imu);
  for (GnssFix& fix : still) fix.covariance_E *= 1e-4;
  passed += 1 - begun("static", "static_s = 5", still, imu);
  for (GnssFix& fix : still) fix.p_A_E.x() = drive.start.p_EU_E.x() + 2.0 * (fix.p_A_E.x() - drive.start.p_EU_E.x());
  passed += begun("static", "static_s = 5", still, imu) + begun("static", "", {}, imu);
  for (const double lat : {90.5, -91.0})
    passed += begun("given", "place_deg_deg_m = [" + number_text(lat) + ", 0, 0]", {}, imu);
  return {1.0 * passed, 0.0};
}

/// At rest: the place is the mean of the fixes meanwhile, and of those after only where there are none; the heading
/// that is given with its own sigma; seconds that nobody gives are ten.
StressFigure resting_starts() {
  Looks looks;
  NavState s = levelled({-33.0 * kDegree, 0.4, 100.0}, 1.1, {0.05, -0.1, 1.0});
  s.t = GpsTime::from_week_sow(1590, 1000.0);
  std::vector<ImuSample> imu;
  for (std::int64_t i = 0; i < 800; ++i) imu.push_back(rest_sample(s, i, 50.0));
  const auto fix_at = [&](double t, const Vector3d& off) {
    GnssFix f;
    f.t = s.t + t, f.status = FixStatus::kSingle;
    f.p_A_E = s.p_EU_E + s.R_EU * (kAerial_B - kUnit_B) + off;
    f.covariance_E = Matrix3d::Identity() * 0.25;
    return f;
  };
  const std::vector<GnssFix> fixes = {fix_at(1.0, {0.3, 0.0, 0.0}), silent_at(s.t + 1.5), fix_at(4.0, {0.0, 0.6, 0.0}),
                                      fix_at(10.01, {0.0, 0.0, -0.9}), fix_at(12.0, {9.0, 9.0, 9.0})};
  const auto begun = [&](const std::string& keys, std::span<const GnssFix> all) {
    return *start_by(
        "static", keys,
        {.imu = imu, .fixes = all, .noise = starting_noise(), .lever_U_B = kUnit_B, .lever_A_B = kAerial_B});
  };
  const double heading_deg = 1.1 / kDegree;
  const Aligned usual = begun("static_heading_deg = " + number_text(heading_deg), fixes),
                late = begun("static_heading_deg = 63\nstatic_heading_sigma_deg = 7", std::span(fixes).subspan(4));
  // Samples that end up to ten seconds after the first one did.
  looks.near(usual.nav.t - s.t, 10.02, 1e-9);
  looks.near((usual.nav.p_EU_E - s.p_EU_E - Vector3d(0.1, 0.2, -0.3)).norm(), 0.0, 1e-4),
      looks.near((late.nav.p_EU_E - s.p_EU_E - Vector3d(9.0, 9.0, 9.0)).norm(), 0.0, 0.02);
  looks.near(usual.heading_rad, kDegree, 1e-12), looks.near(late.heading_rad, 7.0 * kDegree, 1e-12);
  looks.near(usual.velocity_m_s, 0.02, 1e-300);
  looks.near(usual.position_m, std::hypot(0.5, kDegree * (kUnit_B - kAerial_B).norm()), 1e-6);
  looks.near(so3_log(s.R_EU.conjugate() * usual.nav.R_EU).norm(), 0.0, 1e-5);
  return looks.figure();
}

/// Attitudes from a force: it lies where the force says, and no turn about that brings the nose nearer to its heading.
StressFigure from_forces() {
  Looks looks;
  DrawnNumbers draw(12);
  const Vector3d p_E = ecef_from_geodetic({0.6, -1.0, 50.0});
  const Matrix3d R_EN = rotation_E_from_enu(geodetic_from_ecef(p_E));
  for (int trial = 0; trial < 40; ++trial) {
    const Vector3d force_U = 9.8 * (Vector3d::UnitZ() + 0.4 * draw.three()),
                   force_E = R_EN * (9.8 * (Vector3d::UnitZ() + 0.4 * draw.three()));
    const double heading = 2.0 * draw.next();
    const Eigen::Quaterniond R = attitude_from_force(p_E, force_U, force_E, heading);
    looks.near((R * force_U.normalized() - force_E.normalized()).norm(), 0.0, 32.0 * kEpsilon);
    const Vector3d course = R_EN * Vector3d(std::sin(heading), std::cos(heading), 0.0), nose = R * Vector3d::UnitX(),
                   axis = force_E.normalized();
    // Turned about the force its part along the course is least or most where the slope is none; here it is most.
    looks.near(course.dot(axis.cross(nose)), 0.0, 32.0 * kEpsilon);
    looks.right(course.dot(nose) > course.dot(Eigen::AngleAxisd(0.1, axis) * nose) &&
                course.dot(nose) > course.dot(Eigen::AngleAxisd(3.0, axis) * nose));
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> start_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "a start in motion, at rest or by a force",
           "a velocity of the wrong instant, a sigma over the wrong time, a mean of other fixes",
           "where, how fast and how sure by the formulas: Coriolis' part of the force, roundings", "of the bound"});
  rows.add("starts/speeding_up", speeding_up)
      .add("starts/at_rest", resting_starts)
      .add("starts/from_forces", from_forces);
  rows.of({StressGroup::kData, "what is no start", "fixes too far apart, a log that ends before, an antenna that moves",
           "each refused, and the sound ones made", "let through"});
  rows.add("starts/none", no_starts);
  return rows.take();
}

}  // namespace canyon::fusion
