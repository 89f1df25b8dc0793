// Paths of a body where they are, in closed form; paths through points of a file; what an IMU that sits askew makes of
// them, and how exact its sums over nodes are.
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/earth/earth.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/process/staging_litter.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/inertial/motion/motion.h"
#include "canyon/inertial/mounting.h"
#include "canyon/inertial/stress/subjects.h"
#include "canyon/inertial/true_increments.h"

namespace canyon::inertial {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

/// By turns about the axes in turn: yaw from east, pitch, roll.
Quaterniond turned(double yaw, double pitch, double roll) {
  return Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Vector3d::UnitX());
}

/// Where it is and which way round, to roundings of a hundred metres and of an angle's root.
void look_at(Looks& looks, const KinematicState& found, const Vector3d& p, const Quaterniond& R) {
  looks.near((found.X_WB.p - p).norm(), 0.0, 64.0 * kEpsilon * 200.0);
  looks.near((found.X_WB.R.toRotationMatrix() - R.toRotationMatrix()).norm(), 0.0, 64.0 * kEpsilon);
}

/// Speeds that go through a profile: their integral by Simpson's rule over thousandths of each part, exact to the
/// fourth degree of what is of fifth, 1e-13 of it.
double driven_m(const std::vector<double>& t, const std::vector<double>& v, double to_s) {
  const auto speed = [&](double s) {
    if (s <= t.front()) return v.front();
    for (std::size_t i = 1; i < t.size(); ++i)
      if (s < t[i]) {
        const double u = (s - t[i - 1]) / (t[i] - t[i - 1]);
        return v[i - 1] + (v[i] - v[i - 1]) * (10.0 * u * u * u - 15.0 * std::pow(u, 4) + 6.0 * std::pow(u, 5));
      }
    return v.back();
  };
  // From the profile's first time on, to which distances are counted, part by part.
  double sum = 0.0;
  const auto add = [&](double from, double to) {
    constexpr int kParts = 1000;
    const double h = (to - from) / kParts;
    for (int k = 0; k < kParts; ++k) {
      const double a = from + k * h;
      sum += h / 6.0 * (speed(a) + 4.0 * speed(a + 0.5 * h) + speed(std::nextafter(a + h, a)));
    }
  };
  if (to_s < t.front()) {
    add(t.front(), to_s);
    return sum;
  }
  for (std::size_t i = 1; i <= t.size(); ++i) {
    const double end = i < t.size() ? t[i] : kInfinity;
    add(t[i - 1], end < to_s ? end : to_s);
    if (end >= to_s) break;
  }
  return sum;
}

/// Each path in closed form: rest, straight, circle, eight and cone, headings clockwise from north, noses down where
/// pitch is positive.
StressFigure closed_forms() {
  Looks looks;
  for (const double heading_deg : {0.0, 37.0, 90.0, 200.0, -75.0}) {
    MotionConfig c;
    c.heading_deg = heading_deg, c.pitch_deg = 12.0, c.roll_deg = -25.0;
    const double yaw = (90.0 - heading_deg) * kDegree, pitch = 12.0 * kDegree, roll = -25.0 * kDegree;
    const Vector3d ahead = turned(yaw, pitch, 0.0) * Vector3d::UnitX();
    const Vector3d level(std::sin(heading_deg * kDegree), std::cos(heading_deg * kDegree), 0.0);  // east, north
    for (const double t : {0.0, 0.8, 2.5, 4.0, 7.7, 11.0}) {
      c.path = "stationary";
      const auto still = make_motion(c, 1);
      look_at(looks, still->motion->at(t), Vector3d::Zero(), turned(yaw, pitch, roll));
      looks.near(still->motion->at(t).v_WB_W.norm(), 0.0, 1e-300);
      looks.right(std::isinf(still->motion->duration_s()));
      c.path = "straight", c.speed_m_s = -7.0;
      look_at(looks, make_motion(c, 1)->motion->at(t), -7.0 * t * ahead, turned(yaw, pitch, roll));
      MotionConfig profile = c;
      profile.profile_s = {1.0, 4.0, 9.0}, profile.profile_m_s = {2.0, 11.0, -3.0};
      look_at(looks, make_motion(profile, 1)->motion->at(t),
              driven_m(profile.profile_s, profile.profile_m_s, t) * ahead, turned(yaw, pitch, roll));
      MotionConfig circle = c;
      circle.path = "circle", circle.radius_m = 40.0, circle.speed_m_s = 9.0, circle.pitch_deg = 0.0;
      const double angle = 9.0 / 40.0 * t;
      const Vector3d left(-level.y(), level.x(), 0.0);
      look_at(looks, make_motion(circle, 1)->motion->at(t),
              40.0 * (std::sin(angle) * level + (1.0 - std::cos(angle)) * left), turned(yaw + angle, 0.0, roll));
      MotionConfig eight = c;
      eight.path = "figure_eight", eight.length_m = 120.0, eight.width_m = 50.0, eight.period_s = 33.0;
      eight.climb_m = 3.0, eight.sway_deg = 17.0;
      const double u = 2.0 * kPi * t / 33.0, rate = 2.0 * kPi / 33.0;
      const Vector3d p =
          60.0 * std::sin(u) * level + 25.0 * std::sin(2.0 * u) * left + Vector3d(0.0, 0.0, 3.0 * std::sin(2.0 * u));
      const Vector3d v = rate * (60.0 * std::cos(u) * level + 50.0 * std::cos(2.0 * u) * left +
                                 Vector3d(0.0, 0.0, 6.0 * std::cos(2.0 * u)));
      look_at(
          looks, make_motion(eight, 1)->motion->at(t), p,
          turned(std::atan2(v.y(), v.x()), -std::atan2(v.z(), v.head<2>().norm()), 17.0 * kDegree * std::sin(3.0 * u)));
      MotionConfig cone = c;
      cone.path = "coning", cone.cone_deg = 35.0, cone.cone_hz = 0.4;
      const double way = 2.0 * kPi * 0.4 * t;
      look_at(looks, make_motion(cone, 1)->motion->at(t), Vector3d::Zero(),
              turned(yaw, 0.0, 0.0) *
                  Quaterniond(Eigen::AngleAxisd(35.0 * kDegree, Vector3d(std::cos(way), std::sin(way), 0.0))));
    }
    const auto placed = make_motion(c, 1);
    looks.near((placed->frame.to_E(Vector3d::Zero()) -
                ecef_from_geodetic({c.lat_deg * kDegree, c.lon_deg * kDegree, c.height_m}))
                   .norm(),
               0.0, 1e-8);
  }
  return looks.figure();
}

/// A shaker: against a body that moves the IMU is displaced by what two integrals make of its acceleration, and turned
/// by its angles, yaw about the body's z first; of a random one the mean squares of acceleration and velocity over 100
/// seeds are the integrals of a density that is a power of frequency between its corners: five deviations.
StressFigure shaken() {
  Looks looks;
  MotionConfig c;
  c.path = "circle", c.roll_deg = 20.0;
  MotionConfig with = c;
  with.vibration.sinusoid = {
      {.frequency_hz = 4.0, .acceleration_m_s2 = {3.0, -5.0, 8.0}, .angle_deg = {2.0, -3.0, 4.0}, .phase_deg = 30.0},
      {.frequency_hz = 11.0, .acceleration_m_s2 = {-1.0, 2.0, 1.5}, .angle_deg = {0.0, 0.0, 0.0}, .phase_deg = -80.0}};
  const auto calm = make_motion(c, 1), shaking = make_motion(with, 1);
  for (const double t : {0.0, 0.13, 1.71, 6.02}) {
    const KinematicState a = calm->motion->at(t), b = shaking->motion->at(t);
    Vector3d moved = Vector3d::Zero();
    for (const Sinusoid& s : with.vibration.sinusoid) {
      const double w = 2.0 * kPi * s.frequency_hz;
      moved -= s.acceleration_m_s2 / (w * w) * std::sin(w * t + s.phase_deg * kDegree);
    }
    const Vector3d angle = kDegree * Vector3d(2.0, -3.0, 4.0) * std::sin(8.0 * kPi * t + 30.0 * kDegree);
    look_at(looks, b, a.X_WB.p + a.X_WB.R * moved, a.X_WB.R * turned(angle.z(), angle.y(), angle.x()));
  }
  MotionConfig random;
  random.vibration.psd_hz = {2.0, 10.0, 40.0, 90.0}, random.vibration.psd_g2_per_hz = {0.01, 0.04, 0.02, 0.001};
  // Integral of c f^n f^-m between two corners.
  const auto integral = [&](double power) {
    double sum = 0.0;
    for (std::size_t i = 1; i < 4; ++i) {
      const double f0 = random.vibration.psd_hz[i - 1], f1 = random.vibration.psd_hz[i];
      const double n =
          std::log(random.vibration.psd_g2_per_hz[i] / random.vibration.psd_g2_per_hz[i - 1]) / std::log(f1 / f0);
      const double constant = random.vibration.psd_g2_per_hz[i - 1] / std::pow(f0, n), q = n - power + 1.0;
      sum += constant * (std::pow(f1, q) - std::pow(f0, q)) / q;
    }
    return sum;
  };
  double force = 0.0, speed = 0.0, across = 0.0;
  constexpr int kSeeds = 100, kTimes = 5;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto motion = make_motion(random, seed);
    for (int k = 0; k < kTimes; ++k) {
      const KinematicState s = motion->motion->at(3.0 + 10.0 * k);
      force += s.a_WB_W.squaredNorm() / (3.0 * kSeeds * kTimes),
          speed += s.v_WB_W.squaredNorm() / (3.0 * kSeeds * kTimes);
      across += s.a_WB_W.x() * s.a_WB_W.y() / (1.0 * kSeeds * kTimes);
    }
  }
  const double g2 = 9.80665 * 9.80665, n = 3.0 * kSeeds * kTimes, five = 5.0 * std::sqrt(2.0 / n);
  looks.near(force / (g2 * integral(0.0)), 1.0, five),
      looks.near(speed / (g2 * integral(2.0) / (4.0 * kPi * kPi)), 1.0, five);
  looks.near(across / (g2 * integral(0.0)), 0.0, 5.0 / std::sqrt(1.0 * kSeeds * kTimes));
  return looks.figure();
}

/// A file that is gone with this.
class PointsFile {
 public:
  explicit PointsFile(const std::string& text) {
    static int count = 0;
    path_ = (std::filesystem::temp_directory_path() /
             ("canyon_stress_points_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".csv"))
                .string();
    add_litter(path_, {});
    std::ofstream(path_) << text;
  }
  ~PointsFile() {
    std::remove(path_.c_str());
    forget_litter(path_);
  }
  PointsFile(const PointsFile&) = delete;
  PointsFile& operator=(const PointsFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string row_of(const std::vector<double>& values) {
  std::string out;
  for (const double x : values) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    out += (out.empty() ? "" : ",") + std::string(text);
  }
  return out + "\n";
}

Result<PlacedMotion> through(const std::string& text) {
  const PointsFile file(text);
  MotionConfig c;
  c.path = "spline", c.file = file.path();
  return make_motion(c, 1);
}

const std::string kPlaces = "t_s,x_m,y_m,z_m\n", kPoses = "t_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg\n";

/// A path through points of a file: it passes them at their times from the first on, with their attitudes, yaw from
/// east; without attitudes the nose lies along its own velocity and nothing rolls.
StressFigure through_points() {
  Looks looks;
  std::string poses = kPoses, places = kPlaces;
  std::vector<double> t;
  std::vector<Vector3d> p;
  std::vector<Quaterniond> R;
  for (int k = 0; k < 25; ++k) {
    t.push_back(100.0 + 0.7 * k + 0.1 * std::sin(2.0 * k));
    p.emplace_back(20.0 * std::sin(0.3 * k), -6.0 * k, 2.0 * std::cos(0.4 * k));
    const double yaw = 20.0 * k - 170.0, pitch = 15.0 * std::sin(0.5 * k), roll = 30.0 * std::cos(0.35 * k);
    R.push_back(turned(yaw * kDegree, pitch * kDegree, roll * kDegree));
    poses += row_of({t.back(), p.back().x(), p.back().y(), p.back().z(), yaw, pitch, roll});
    places += row_of({t.back(), p.back().x(), p.back().y(), p.back().z()});
  }
  const auto posed = through(poses), placed = through(places);
  if (!posed || !placed) return {kInfinity, 1.0};
  looks.near(posed->motion->duration_s(), t.back() - t.front(), 1e-12);
  looks.near(placed->motion->duration_s(), t.back() - t.front(), 1e-12);
  for (std::size_t k = 0; k < t.size(); ++k) {
    const KinematicState a = posed->motion->at(t[k] - t[0]), b = placed->motion->at(t[k] - t[0]);
    // Elimination of blocks of up to 720 over intervals of 0.6 s and more: 64 roundings of the way's 150 m.
    looks.near((a.X_WB.p - p[k]).norm() + (b.X_WB.p - p[k]).norm(), 0.0, 64.0 * kEpsilon * 150.0);
    looks.near((a.X_WB.R.toRotationMatrix() - R[k].toRotationMatrix()).norm(), 0.0, 64.0 * kEpsilon);
    looks.near((b.X_WB.R * Vector3d::UnitX() - b.v_WB_W.normalized()).norm(), 0.0, 64.0 * kEpsilon);
    looks.near((b.X_WB.R * Vector3d::UnitY()).z(), 0.0, 16.0 * kEpsilon);
    looks.right((b.X_WB.R * Vector3d::UnitZ()).z() > 0.0);
  }
  // Turns of nearly 120 degrees from point to point, and attitudes of either sign of their quaternion.
  std::string wide = kPoses;
  for (int k = 0; k < 8; ++k) wide += row_of({1.0 * k, 0.0, 0.0, 0.0, 119.0 * k, 0.0, 0.0});
  looks.right(through(wide).ok());
  return looks.figure();
}

/// Files that make no path, and motions that cannot be: each refused.
StressFigure refused_paths() {
  int passed = 0;
  const auto row = [](double t, double x, double y) { return row_of({t, x, y, 0.0}); };
  for (const std::string& text :
       {kPlaces + row(0, 0, 0) + row(1, 5, 0),                                          // two points
        kPlaces + row(0, 0, 0) + row(1, 5, 0) + row(1, 10, 0) + row(2, 15, 0),          // a time twice
        kPlaces + row(0, 0, 0) + row(2, 5, 0) + row(1, 10, 0) + row(3, 15, 0),          // a time that goes back
        kPlaces + row(0, 0, 0) + row(1, 0, 0) + row(2, 0, 0) + row(3, 0, 0),            // no way
        kPlaces + row(0, 0, 0) + row(1, 5, 0) + row(2, 0, 0) + row(3, -5, 0),           // back the same way
        kPlaces + row_of({0, 0, 0}) + row_of({1, 5, 0}) + row_of({2, 9, 0}),            // a column short
        kPlaces + row(0, 0, 0) + row(1, 5, 0) + row(2e9, 15, 0),                        // no time
        std::string("t_s,y_m,x_m,z_m\n") + row(0, 0, 0) + row(1, 5, 0) + row(2, 9, 0),  // another header
        kPoses + row_of({0, 0, 0, 0, 0, 0, 0}) + row_of({1, 0, 0, 0, 125, 0, 0}) + row_of({2, 0, 0, 0, 250, 0, 0})})
    passed += through(text).ok() ? 1 : 0;
  MotionConfig c;
  c.path = "spline";
  passed += make_motion(c, 1).ok() ? 1 : 0;
  c.path = "straight", c.profile_s = {1.0, 2.0}, c.profile_m_s = {1.0};
  passed += make_motion(c, 1).ok() ? 1 : 0;
  c.profile_s = {2.0, 2.0}, c.profile_m_s = {1.0, 3.0};
  passed += make_motion(c, 1).ok() ? 1 : 0;
  c = {};
  c.vibration.psd_hz = {5.0}, c.vibration.psd_g2_per_hz = {1.0};
  passed += make_motion(c, 1).ok() ? 1 : 0;
  c.vibration.psd_hz = {5.0, 2.0}, c.vibration.psd_g2_per_hz = {1.0, 1.0};
  passed += make_motion(c, 1).ok() ? 1 : 0;
  c.vibration.psd_hz = {5.0, 7.0, 9.0};
  passed += make_motion(c, 1).ok() ? 1 : 0;
  return {1.0 * passed, 0.0};
}

/// A unit askew by a drawn angle, the same for all samples: what it measures are the increments turned by it, nothing
/// else where it has no errors; over 300 units each angle is normal with the stated sigma.
StressFigure askew() {
  Looks looks;
  ImuConfig config;
  config.errors = "none", config.lever_arm_m = Vector3d(0.5, -0.2, 0.9);
  MotionConfig path;
  path.path = "figure_eight", path.sway_deg = 20.0;
  const PlacedMotion motion = *make_motion(path, 1);
  std::vector<KinematicState> nodes;
  for (int k = 0; k <= 4; ++k) {
    nodes.push_back(motion.motion->at(3.0 + 0.0025 * k));
    nodes.back().t = GpsTime{} + (3.0 + 0.0025 * k);
  }
  const ImuSample exact = true_increments(nodes, motion.frame, config.lever_arm_m);
  const auto parallel = make_imu(config, 1, motion.frame);
  looks.right(parallel.ok() && (*parallel)->R_BU().coeffs() == Quaterniond::Identity().coeffs() &&
              !mounting(config, 1));
  looks.right((*parallel)->sample(7, nodes).dv_U == exact.dv_U &&
              (*parallel)->sample(7, nodes).dtheta_U == exact.dtheta_U);
  config.mounting_error_deg = 2.0;
  Vector3d mean = Vector3d::Zero(), square = Vector3d::Zero();
  constexpr int kUnits = 300;
  for (std::uint64_t seed = 1; seed <= kUnits; ++seed) {
    const auto R_BU = mounting(config, seed);
    const Vector3d angle = so3_log(*R_BU) / (2.0 * kDegree);
    mean += angle / kUnits, square += angle.cwiseAbs2() / kUnits;
    if (seed > 10) continue;
    const auto unit = make_imu(config, seed, motion.frame);
    looks.near((*unit)->R_BU().angularDistance(*R_BU), 0.0, 1e-300);
    const ImuSample seen = (*unit)->sample(7, nodes);
    looks.near((*R_BU * seen.dtheta_U - exact.dtheta_U).norm() / exact.dtheta_U.norm(), 0.0, 16.0 * kEpsilon);
    looks.near((*R_BU * seen.dv_U - exact.dv_U).norm() / exact.dv_U.norm(), 0.0, 16.0 * kEpsilon);
    looks.right(seen.t == exact.t && seen.dt_s == exact.dt_s);
  }
  for (int axis = 0; axis < 3; ++axis) {
    looks.near(mean[axis], 0.0, 5.0 / std::sqrt(1.0 * kUnits));
    looks.near(square[axis], 1.0, 5.0 * std::sqrt(2.0 / kUnits));
  }
  looks.right(stress::not_refused([&] { (*parallel)->sample(-1, nodes); }) == 0);
  return looks.figure();
}

/// Sums over 3 to 13 nodes: Boole's rule where the intervals are a multiple of four, exact to the fifth degree, else
/// Simpson's, to the third, and what either leaves of the next even degree is its known remainder; nodes that are even
/// in number, uneven or no numbers are refused.
StressFigure sums_over_nodes() {
  Looks looks;
  const LocalFrame frame(Geodetic{0.5, 1.0, 100.0});
  constexpr double kInterval_s = 0.08;
  const Vector3d still = inertial_input({}, frame, Vector3d::Zero()).w_IU_U;
  for (const int intervals : {2, 4, 6, 8, 10, 12})
    for (int degree = 0; degree <= 6; ++degree) {
      std::vector<KinematicState> nodes;
      for (int i = 0; i <= intervals; ++i) {
        const double x = static_cast<double>(i) / intervals;
        KinematicState s;
        s.t = GpsTime{} + kInterval_s * x;
        s.w_WB_B = std::pow(x, degree) * Vector3d(1.0, -2.0, 3.0);
        nodes.push_back(s);
      }
      const Vector3d found = true_increments(nodes, frame, Vector3d::Zero()).dtheta_U / kInterval_s - still;
      const bool boole = intervals % 4 == 0;
      double left = 0.0;
      const double h = 1.0 / intervals;
      // Remainders: h^4 / 180 of the third derivative's growth, 2 h^6 / 945 of the fifth's.
      if (!boole && degree == 4) left = std::pow(h, 4) / 180.0 * 24.0;
      if (boole && degree == 6) left = 2.0 * std::pow(h, 6) / 945.0 * 720.0;
      if (!boole && degree > 4) continue;
      looks.near((found - (1.0 / (degree + 1.0) + left) * Vector3d(1.0, -2.0, 3.0)).norm(), 0.0, 64.0 * kEpsilon);
    }
  std::vector<KinematicState> nodes(5);
  for (std::size_t i = 0; i < 5; ++i) nodes[i].t.ns = 1'000'000 * static_cast<std::int64_t>(i);
  const auto refused = [&](auto change) {
    std::vector<KinematicState> bad = nodes;
    change(bad);
    looks.right(stress::not_refused([&] { true_increments(bad, frame, Vector3d::Zero()); }) == 0);
  };
  looks.right(stress::not_refused([&] { true_increments(nodes, frame, Vector3d::Zero()); }) == 1);
  refused([](auto& n) { n.pop_back(); });
  refused([](auto& n) { n.resize(1); });
  refused([](auto& n) { n[2].t.ns += 3; });
  refused([](auto& n) { n[2].w_WB_B.y() = std::nan(""); });
  refused([](auto& n) { n[1].a_WB_W.z() = kInfinity; });
  refused([](auto& n) {
    for (auto& s : n) s.t = GpsTime{};
  });
  return looks.figure();
}

}  // namespace

std::vector<StressCase> path_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "paths of a body where they are",
           "a heading of the other hand, a centre to the right, a wave of the wrong axis or number",
           "closed forms to roundings, and of random vibration its density's integrals: five deviations",
           "of the bound"});
  rows.add("paths/closed_forms", closed_forms).add("paths/shaken", shaken);
  rows.of({StressGroup::kData, "paths through points of a file",
           "a column of another axis, a time from another beginning",
           "each point at its time, noses along the way: roundings", "of the bound"});
  rows.add("paths/through_points", through_points);
  rows.of({StressGroup::kData, "points that make no path", "a halt whose direction is none, a profile of other lengths",
           "each is refused", "let through"});
  rows.add("paths/refused", refused_paths);
  rows.of({StressGroup::kGeometry, "a unit that sits askew, and its sums over nodes",
           "a turn of the other sense, weights of another rule",
           "increments turned back, powers of time to their degree and the rules' remainders: roundings",
           "of the bound"});
  rows.add("paths/askew", askew).add("paths/sums_over_nodes", sums_over_nodes);
  return rows.take();
}

}  // namespace canyon::inertial
