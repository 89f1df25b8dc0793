// A sensor that turns fast, beyond its recorded motion, in a wall, far away; scans counted for years.
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/deskew.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/scanner.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::lidar {
namespace {

using stress::kHalfUlp;
const GpsTime kStart{1'000'000'000'000'000'000};

Vector6d twist(double deg_s, double speed_m_s) {
  Vector6d out;
  out << deg_s * kDegree * Eigen::Vector3d(0.3, -0.4, 0.87).normalized(), speed_m_s * Eigen::Vector3d(0.8, 0.6, 0.0);
  return out;
}

/// Poses every 10 ms on a screw motion, which interpolation on SE(3) follows exactly.
Trajectory screw(const Pose& at_start, const Vector6d& per_s, double from_s, double to_s) {
  Trajectory out;
  const auto first = std::lround(from_s / 0.01), last = std::lround(to_s / 0.01);
  for (long k = first; k <= last; ++k)
    out.append({kStart + 0.01 * static_cast<double>(k), at_start * Pose::exp(per_s * (0.01 * static_cast<double>(k)))});
  return out;
}

/// Points that stand still, seen by a sensor that turns: deskewed they stand where they do at the stamp. Documented:
/// 3e-8 rad and 1 um of the chords; single precision of points in and out: sqrt 3 half units each.
StressFigure deskewed(double deg_s, double speed_m_s) {
  const Vector6d per_s = twist(deg_s, speed_m_s);
  const Pose X_BL{Eigen::Quaterniond::Identity(), {0.3, 0.0, 1.8}},
      begin{Eigen::Quaterniond::Identity(), {40.0, -20.0, 1.0}};
  const Trajectory motion = screw(begin, per_s, -0.2, 0.1);
  LidarScan scan{.t = kStart, .period_s = 0.1, .points = {}};
  std::vector<Eigen::Vector3d> exact;
  for (int k = 0; k < 4000; ++k) {
    LidarPoint point;
    point.time_s = static_cast<float>(-0.1 + 0.1 * k / 4000.0);
    const Eigen::Vector3d p_W =
        begin.p + 60.0 * Eigen::Vector3d(std::sin(1.0 * k), std::cos(1.3 * k), 0.3 * std::sin(2.0 * k));
    const Pose X_WL = begin * Pose::exp(per_s * double{point.time_s}) * X_BL;
    const Eigen::Vector3f p = (X_WL.inverse() * p_W).cast<float>();
    point.x = p.x(), point.y = p.y(), point.z = p.z();
    scan.points.push_back(point);
    exact.push_back((begin * X_BL).inverse() * p_W);
  }
  const LidarScan out_scan = deskew(scan, motion, X_BL);
  if (out_scan.points.size() != exact.size()) return {std::numeric_limits<double>::infinity(), 1.0};
  StressFigure out{0.0, 3e-8 * 65.0 + 1e-6 + 2.0 * std::sqrt(3.0) * kHalfUlp * 64.0};
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const LidarPoint& p = out_scan.points[k];
    take_worst(out, (Eigen::Vector3d(p.x, p.y, p.z) - exact[k]).norm());
  }
  return out;
}

/// Motion that begins in the middle of the scan, ends before it, or is none at all: points it does not cover are
/// dropped, the others kept; points that are not finite are dropped. A figure counts points too many or too few.
StressFigure beyond_the_motion() {
  LidarScan scan{.t = kStart, .period_s = 0.1, .points = {}};
  for (int k = 0; k <= 100; ++k) {
    LidarPoint point;
    point.x = 10.0f, point.time_s = static_cast<float>(-0.001 * (100 - k));
    scan.points.push_back(point);
  }
  const auto left = [&](const LidarScan& s, const Trajectory& motion) {
    return static_cast<double>(deskew(s, motion, Pose{}).points.size());
  };
  const Vector6d per_s = twist(100.0, 5.0);
  StressFigure out;
  out.figure += std::abs(left(scan, screw({}, per_s, -0.5, 0.5)) - 101.0);
  out.figure += std::abs(left(scan, screw({}, per_s, -0.05, 0.5)) - 51.0);
  out.figure += left(scan, screw({}, per_s, -0.5, -0.02));  // nothing at the stamp: nothing to deskew to
  out.figure += left(scan, screw({}, per_s, 1.0, 2.0)) + left(scan, Trajectory{});
  out.figure += std::abs(left(scan, screw({}, per_s, 0.0, 0.0)) - 1.0);  // one pose, at the stamp
  out.figure += left(LidarScan{.t = kStart, .period_s = 0.1, .points = {}}, screw({}, per_s, -0.5, 0.5));
  LidarScan odd = scan;
  odd.points[3].time_s = std::numeric_limits<float>::quiet_NaN();
  odd.points[4].time_s = std::numeric_limits<float>::infinity();
  odd.points[5].x = std::numeric_limits<float>::quiet_NaN();
  odd.points[6].z = -std::numeric_limits<float>::infinity();
  out.figure += std::abs(left(odd, screw({}, per_s, -0.5, 0.5)) - 97.0);
  return out;
}

LidarConfig plain(const std::string& beams) {
  LidarConfig c;
  c.beams = beams;
  c.mount_m.setZero();
  c.range_noise_m = 0.0;
  c.report.range_quantum_m = 0.0;
  c.report.min_range_m = 1e-4;
  return c;
}

/// A room of 32 x 24 x 8 m about a place.
std::unique_ptr<scene::Scene> room(const Eigen::Vector3d& middle) {
  scene::SceneParts parts;
  parts.name = "room";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("room", scene::ObjectKind::kBuilding);
  mesh.box(middle, Eigen::Matrix3d::Identity(), {16.0, 12.0, 4.0}, mesh.material("concrete"));
  return std::make_unique<scene::Scene>(std::move(parts));
}

double off_the_room(const Eigen::Vector3d& p) {
  const Eigen::Vector3d beyond = p.cwiseAbs() - Eigen::Vector3d(16.0, 12.0, 4.0);
  return beyond.maxCoeff<Eigen::PropagateNaN>() > 0.0 ? beyond.cwiseMax(0.0).norm()
                                                      : -beyond.maxCoeff<Eigen::PropagateNaN>();
}

/// Points of a turning sensor, each put where it was seen from, lie on the room's walls. Directions in single
/// precision: six operations, half a unit each, over 20 m, which a slant by up to 5 enlarges; chords as documented;
/// lasers that fire `late_s` after their cycle are placed to first order: (w late)^2 / 2; points in single precision.
StressFigure walls_of_a_room(const std::string& beams, double deg_s, double late_s, double place_m) {
  const Eigen::Vector3d middle(place_m, -place_m, 0.0);
  const auto scene = room(middle);
  const Vector6d per_s = twist(deg_s, deg_s == 0.0 ? 0.0 : 3.0);
  const Pose begin{Eigen::Quaterniond::Identity(), middle + Eigen::Vector3d(1.0, -2.0, 0.5)};
  const Trajectory motion = screw(begin, per_s, -0.2, 0.1);
  auto scanner = make_scanner(plain(beams), 1);
  if (!scanner.ok()) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  const LidarOutput got = (*scanner)->scan(0, kStart, motion, scene::SceneAt(*scene));
  const double bend = 0.5 * std::pow(deg_s * kDegree * late_s, 2);
  // A point's time_s is in single precision: 3.7 ns of the turn.
  StressFigure out{0.0, 5.0 * 20.0 * (6.0 * kHalfUlp + 3e-8 + bend + 4e-9 * deg_s * kDegree) + 1e-6 + 2e-15 * place_m};
  if (got.scan.points.size() < 10000) out.figure = std::numeric_limits<double>::infinity();
  for (const LidarPoint& p : got.scan.points) {
    const Eigen::Vector3d p_W = begin * Pose::exp(per_s * double{p.time_s}) * Eigen::Vector3d(p.x, p.y, p.z);
    take_worst(out, off_the_room(p_W - middle));
  }
  return out;
}

/// Every echo model and detector, from within a wall, on it, 1 mm above level ground, and over nothing: finite points
/// within the limits. A figure counts others. And it sees: 2 m above the ground seven of 16 lasers meet it within 40 m,
/// 2520 shots, of which a fifth are asked for.
StressFigure everywhere_finite(const char* model, const char* detector) {
  scene::SceneParts parts;
  parts.name = "ground and wall";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}, mesh.material("asphalt"));
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({8, 50, 0}, {8, -50, 0}, {8, -50, 10}, {8, 50, 10}, mesh.material("glass"));
  const scene::Scene scene(std::move(parts));
  LidarConfig c = plain("vlp16");
  c.azimuth_steps = 360;
  c.model.name = model, c.detector.name = detector;
  c.see_through.panes = true;
  c.report.returns = ReturnMode::kAll;
  auto scanner = make_scanner(c, 1);
  if (!scanner.ok()) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  StressFigure out;
  std::int64_t index = 0;
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(8, 0, 2), Eigen::Vector3d(std::nextafter(8.0, 9.0), 0, 2),
                                    Eigen::Vector3d(0, 0, 1e-3), Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(8, 50, 10),
                                    Eigen::Vector3d(0, 0, -5), Eigen::Vector3d(1e6, 0, 2), Eigen::Vector3d(0, 0, 2)}) {
    Trajectory motion;
    motion.append({kStart - 1.0, {Eigen::Quaterniond::Identity(), at}});
    motion.append({kStart + 1.0, {Eigen::Quaterniond::Identity(), at}});
    const LidarOutput got = (*scanner)->scan(index++, kStart, motion, scene::SceneAt(scene));
    for (const LidarPoint& p : got.scan.points) {
      const double range_m = std::hypot(p.x, p.y, p.z);
      out.figure +=
          std::isfinite(range_m) && range_m <= 100.1 && p.intensity >= 0.0f && p.intensity <= 1.0f && p.time_s <= 0.0f
              ? 0.0
              : 1.0;
    }
    if (at == Eigen::Vector3d(0, 0, 2)) out.figure += got.scan.points.size() >= 504 ? 0.0 : 1e6;
    for (const LidarPointTruth& t : got.truth)
      out.figure += std::isfinite(t.range_m) && t.cos_incidence >= 0.0f && t.cos_incidence <= 1.0001f ? 0.0 : 1.0;
  }
  return out;
}

/// A pose that is not finite, or a motion that does not cover the scan, is refused; a figure counts scans.
StressFigure not_finite() {
  const auto scene = room(Eigen::Vector3d::Zero());
  StressFigure out;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e30})
    for (int field = 0; field < 4; ++field) {
      auto scanner = make_scanner(plain("vlp16"), 1);
      Pose pose;
      if (field < 3) pose.p[field] = bad;
      if (field == 3) {
        if (bad == 1e30) continue;
        pose.R.w() = bad;
      }
      out.figure += stress::not_refused([&] {
        Trajectory motion;
        motion.append({kStart - 1.0, pose});
        motion.append({kStart + 1.0, pose});
        (*scanner)->scan(0, kStart, motion, scene::SceneAt(*scene));
      });
    }
  return out;
}

/// Lasers that run free: each scan begins with the cycle after the last of the scan before, cycles of years count to
/// the number that the time holds, and start within the scan. A figure counts scans that do not.
StressFigure cycles(std::int64_t first, double rate_hz) {
  const auto table = load_beam_table("vlp16");
  if (!table.ok()) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  const FiringPattern pattern(*table, rate_hz, 0);
  StressFigure out;
  FiringPattern::Sweep before = pattern.sweep(first);
  for (std::int64_t k = first + 1; k < first + 2000; ++k) {
    const FiringPattern::Sweep now = pattern.sweep(k);
    const bool follows = now.first_cycle == before.first_cycle + before.cycles;
    const bool within = now.start_s <= 0.0 && now.start_s >= -1.0 / rate_hz - pattern.step_s() - 1e-6;
    out.figure += follows && within ? 0.0 : 1.0;
    before = now;
  }
  return out;
}

}  // namespace

std::vector<StressCase> motion_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "deskewing a sensor that turns fast",
           "motion between samples taken as straight; a rotation to first order; nodes no closer than a fixed time",
           "3e-8 rad and 1 um of the chords as documented, single precision of the points", "m"});
  struct Turn {
    double deg_s, m_s;
    const char* name;
  };
  for (const Turn& t : {Turn{0.0, 0.0, "at_rest"}, Turn{100.0, 20.0, "100_deg_s"}, Turn{500.0, 5.0, "500_deg_s"},
                        Turn{2000.0, 5.0, "2000_deg_s"}, Turn{5000.0, 100.0, "5000_deg_s"}})
    rows.add(std::string("motion/deskew_") + t.name, [t] { return deskewed(t.deg_s, t.m_s); });
  rows.of({StressGroup::kData, "a scan beyond its recorded motion, or with points that are none",
           "extrapolation, the nearest pose, an index before the first",
           "points not covered are dropped, the others kept", "points"});
  rows.add("motion/deskew_beyond_the_motion", beyond_the_motion);
  rows.of({StressGroup::kStiff, "beams of a turning sensor against a room's walls",
           "all beams of a turn from one pose; lasers of a cycle at one instant; coordinates in single precision",
           "on the walls to six half units over a slant of 5, chords, and (w late)^2 / 2", "m"});
  rows.add("motion/room_at_rest", [] { return walls_of_a_room("grid:16:-15:15", 0.0, 0.0, 0.0); })
      .add("motion/room_at_2000_deg_s", [] { return walls_of_a_room("grid:16:-15:15", 2000.0, 0.0, 0.0); })
      .add("motion/room_at_2000_deg_s_lasers_in_turn", [] { return walls_of_a_room("vlp16", 2000.0, 54e-6, 0.0); })
      .add("motion/room_at_1e7_m", [] { return walls_of_a_room("grid:16:-15:15", 100.0, 0.0, 1e7); });
  rows.of({StressGroup::kGeometry, "a sensor in a wall, on the ground and beside everything",
           "0 / 0 of footprints and panes, ranges of infinity told as points", "finite points within the limits",
           "wrong"});
  for (const char* model : {"single_ray", "footprint"})
    for (const char* detector : {"ideal", "radiometric"})
      rows.add(std::string("motion/everywhere_") + model + "_" + detector,
               [=] { return everywhere_finite(model, detector); });
  rows.of({StressGroup::kData, "a pose that is not finite, or beyond all places",
           "rays of NaN, or a ray tracer that ends the process", "refused, field by field", "scans"});
  rows.add("motion/not_finite_field_by_field", not_finite);
  rows.of({StressGroup::kLong, "firing cycles counted for years",
           "a cycle twice or never at a scan's border: a count from a rounded time",
           "each scan follows the one before, within its period", "scans"});
  rows.add("motion/cycles_of_the_first_scans", [] { return cycles(0, 10.0); })
      .add("motion/cycles_after_a_day", [] { return cycles(864'000, 10.0); })
      .add("motion/cycles_after_ten_years", [] { return cycles(3'155'760'000, 10.0); })
      .add("motion/cycles_at_7.77_hz", [] { return cycles(1'000'000, 7.77); });
  return rows.take();
}

}  // namespace canyon::lidar
