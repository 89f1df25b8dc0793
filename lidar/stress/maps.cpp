// Maps and ways against their truth, where the answer is known in closed form; tables of beams; light of others.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/random/random.h"
#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/map_quality/map_report.h"
#include "canyon/lidar/map_quality/point_grid.h"
#include "canyon/lidar/map_quality/trajectory_error.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/scene/mesh_builder.h"
#include "canyon/scene/scene.h"

namespace canyon::lidar {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using stress::kEpsilon;
using stress::kInfinity;
using stress::text;

constexpr float kSide = 40.0f;

/// A level square of 80 m at z = 0 and a wall of 80 m x 20 m in the plane x = 40.
scene::Scene square_and_wall() {
  scene::SceneParts parts;
  parts.name = "square";
  parts.materials = scene::builtin_materials();
  scene::MeshBuilder mesh(parts);
  mesh.begin_object("ground", scene::ObjectKind::kTerrain);
  mesh.quad({-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0}, mesh.material("asphalt"));
  mesh.begin_object("wall", scene::ObjectKind::kWall);
  mesh.quad({40, 40, 0}, {40, -40, 0}, {40, -40, 20}, {40, 40, 20}, mesh.material("concrete"));
  return scene::Scene(std::move(parts));
}

/// Of the ground, `up_m` too high, and nowhere near the wall.
std::vector<Vector3f> ground_at(float up_m) {
  std::vector<Vector3f> out;
  for (int i = 0; i < 60; ++i)
    for (int k = 0; k < 60; ++k) out.emplace_back(-35.0f + static_cast<float>(i), -30.0f + static_cast<float>(k), up_m);
  return out;
}

/// A map of a level ground that is too high by one height everywhere: all of its figures are known. Single numbers are
/// exact in double ones, and a sum of n equal squares rounds by n eps / 2 at most; a share is right or wrong. A figure
/// is the worst share of that, 1e9 for a wrong share.
StressFigure lifted_map(float up_m) {
  const scene::Scene scene = square_and_wall();
  const auto map = ground_at(up_m);
  MapTruth truth;
  truth.points_W = ground_at(0.0f);
  truth.sensor_W = {{-35.0f, -30.0f, up_m}, {24.0f, 29.0f, up_m}};
  const double cap_m = 2.0, d = std::abs(static_cast<double>(up_m));
  const MapReport report = report_map(map, scene, truth, cap_m, 1.5);
  const double expected = std::min(d, cap_m), grain = 0.5 * 3600.0 * kEpsilon * worse(d, 1.0);
  StressFigure out{0.0, 1.0};
  const auto near = [&](double found, double wanted, double within) {
    take_worst(out, std::abs(found - wanted) / within);
  };
  const auto right = [&](bool holds) { take_worst(out, holds ? 0.0 : 1e9); };
  const auto n = static_cast<std::int64_t>(map.size());
  right(report.points == n && report.all.points == (d < cap_m ? n : 0));
  near(report.all.rms_m, expected, grain);
  near(report.p95_m, expected, grain);
  right(report.capped_points == (d < cap_m ? 0 : n));
  if (d < cap_m) {
    near(report.all.up_rms_m, d, grain);
    near(report.all.across_rms_m, 0.0, grain);
    near(report.all.signed_mean_m, static_cast<double>(up_m), grain);
    near(report.level_up_rms_m, d, grain);
  }
  for (std::size_t k = 0; k < kWithin_m.size(); ++k) {
    // 5, 10 and 20 cm, as the docs have them.
    const double within_m = k == 0 ? 0.05 : k == 1 ? 0.10 : 0.20;
    if (std::abs(d - within_m) < 1e-3) continue;
    const double share = d < within_m ? 1.0 : 0.0;
    right(report.accuracy[k] == share && report.completeness[k] == share);
    right(share == 1.0 ? report.f_score[k] == 1.0 : !(report.f_score[k] > 0.0));
  }
  near(report.chamfer_m, 2.0 * expected, 2.0 * grain);
  std::int64_t by_range = 0;
  for (const MapErrors& part : report.by_range) by_range += part.points;
  right(by_range == report.all.points || d >= cap_m);
  return out;
}

/// A wall that stands twice, `gap_m` apart: its patches are that thick, and doubled from 0.1 m on. Coordinates of 40 m
/// in single precision are 2e-6 m apart, and thickness is a difference of two.
StressFigure doubled_wall(float gap_m) {
  const scene::Scene scene = square_and_wall();
  std::vector<Vector3f> map;
  for (int i = 0; i < 120; ++i)
    for (int k = 0; k < 60; ++k)
      map.emplace_back(kSide + ((i + k) % 2 == 0 ? -0.5f : 0.5f) * gap_m, -30.0f + 0.5f * static_cast<float>(i),
                       2.0f + 0.25f * static_cast<float>(k));
  const MapReport report = report_map(map, scene, {}, 2.0, 1.0);
  StressFigure out{0.0, 1.0};
  take_worst(out, report.walls.patches > 100 ? 0.0 : 1e9);
  take_worst(out, std::abs(report.walls.median_m - static_cast<double>(gap_m)) / 1e-5);
  take_worst(out, report.walls.doubled_share == (gap_m > 0.1f ? 1.0 : 0.0) ? 0.0 : 1e9);
  if (gap_m > 0.1f) take_worst(out, std::abs(report.walls.doubled_gap_median_m - static_cast<double>(gap_m)) / 1e-5);
  return out;
}

/// Entropy and plane variance of a cloud against the scatter of each point's neighbours by trying all pairs. The
/// plane's variance is a small one of a scatter of 0.2 m^2 and rounds by some ten eps of that; a logarithm of one that
/// is (1 mm)^2 at least by as much over 1e-6 m^2, 1e-10, and the mean over 600 points by a tenth.
StressFigure crispness(float thick_m) {
  const RandomStream draws(5, "stress.maps");
  std::vector<Vector3f> map;
  for (std::uint64_t k = 0; k < 600; ++k)
    map.emplace_back(static_cast<float>(draws.uniform(-3, 3, 0, k)), static_cast<float>(draws.uniform(-3, 3, 1, k)),
                     thick_m * static_cast<float>(draws.uniform(-1, 1, 2, k)));
  const double radius_m = 1.0;
  const SelfConsistency found = self_consistency(PointGrid(map, 1.0), radius_m);
  double entropy = 0.0, variance = 0.0;
  std::int64_t counted = 0;
  for (const Vector3f& p : map) {
    std::vector<Vector3d> near;
    for (const Vector3f& q : map)
      if ((q.cast<double>() - p.cast<double>()).norm() <= radius_m) near.push_back(q.cast<double>());
    if (near.size() < kFewestNeighbours) continue;
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& q : near) mean += q / static_cast<double>(near.size());
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    for (const Vector3d& q : near) S += (q - mean) * (q - mean).transpose() / static_cast<double>(near.size());
    const Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(S).eigenvalues();
    variance += values.minCoeff<Eigen::PropagateNaN>();
    for (int i = 0; i < 3; ++i) entropy += 0.5 * std::log(2.0 * kPi * std::exp(1.0) * worse(values[i], 1e-6));
    ++counted;
  }
  StressFigure out{0.0, 1.0};
  take_worst(out, found.points == counted ? 0.0 : 1e9);
  take_worst(out, std::abs(found.mean_map_entropy - entropy / static_cast<double>(counted)) / 1e-11);
  take_worst(out, std::abs(found.mean_plane_variance_m2 - variance / static_cast<double>(counted)) / 1e-15);
  return out;
}

Trajectory spiral(const Pose& moved, double stretched) {
  Trajectory out;
  for (int k = 0; k < 400; ++k) {
    const double a = 0.05 * k;
    const Pose X{rotation_from({.yaw_rad = a, .pitch_rad = 0.1 * std::sin(a), .roll_rad = 0.2 * std::cos(a)}),
                 {10.0 * std::cos(a), 10.0 * std::sin(a), 0.3 * a}};
    out.append({GpsTime::from_week_sow(2000, 100.0 + 0.1 * k), moved * Pose{X.R, stretched * X.p}});
  }
  return out;
}

/// A way that was turned and moved as a whole is found again: no error is left but rounding of coordinates `far_m` from
/// the origin, and what was done is told. Without it errors are what was done.
StressFigure moved_way(double far_m) {
  const Trajectory truth = spiral({}, 1.0);
  const Pose yawed{rotation_from({.yaw_rad = 2.5, .pitch_rad = 0.0, .roll_rad = 0.0}), {far_m, -far_m, 3.0}};
  const Pose turned{rotation_from({.yaw_rad = -1.0, .pitch_rad = 0.4, .roll_rad = 2.8}), {far_m, 2.0 * far_m, -far_m}};
  const double grain_m = 64.0 * kEpsilon * (far_m + 20.0);
  StressFigure out{0.0, 1.0};
  const auto yaw = trajectory_errors(truth, spiral(yawed, 1.0), TrajectoryAlignment::kYaw);
  const auto se3 = trajectory_errors(truth, spiral(turned, 1.0), TrajectoryAlignment::kSe3);
  const auto none = trajectory_errors(truth, spiral(Pose{Eigen::Quaterniond::Identity(), {far_m, 0.0, 0.0}}, 1.0),
                                      TrajectoryAlignment::kNone);
  take_worst(out, yaw.ate_max_m / grain_m);
  take_worst(out, se3.ate_max_m / grain_m);
  take_worst(out, (yaw.X_true_estimated * yawed).p.norm() / (4.0 * grain_m));
  take_worst(out, (se3.X_true_estimated * turned).p.norm() / (4.0 * grain_m));
  take_worst(out, std::abs(none.ate_rms_m - far_m) / grain_m);
  take_worst(out, std::abs(none.ate_median_m - far_m) / grain_m);
  for (const RelativeErrors& r : se3.relative) {
    if (r.pairs == 0) continue;
    take_worst(out, r.translation_rms_m / (4.0 * grain_m));
    take_worst(out, r.rotation_rms_deg / 1e-5);  // a logarithm near no rotation is known to sqrt(eps) of a degree
  }
  return out;
}

/// A straight way estimated too long by a share: over so much way, and over so much time, the motion is wrong by just
/// that share of it. Stretches are those that just reach the length, on poses 0.1 m apart.
StressFigure stretched_way(double share) {
  Trajectory truth, estimate;
  for (int k = 0; k < 2500; ++k) {
    const GpsTime t = GpsTime::from_week_sow(2000, 100.0 + 0.1 * k);
    truth.append({t, {Eigen::Quaterniond::Identity(), {0.1 * k, 0.0, 0.0}}});
    estimate.append({t, {Eigen::Quaterniond::Identity(), {0.1 * k * (1.0 + share), 0.0, 0.0}}});
  }
  const auto errors = trajectory_errors(truth, estimate, TrajectoryAlignment::kNone);
  StressFigure out{0.0, 1.0};
  for (const RelativeErrors& r : errors.relative) {
    // At 1 m/s so many metres take so many seconds; a stretch may be one pose, 0.1 m, longer by rounding.
    const double length_m = std::stod(r.over);
    take_worst(out, r.pairs > 0 ? 0.0 : 1e9);
    take_worst(out, (r.translation_rms_m / share - length_m) / 0.1 * (1.0 - 1e-6));
    take_worst(out, beyond(length_m, r.translation_rms_m / share * (1.0 + 1e-6)) * 1e9);
    take_worst(out, r.rotation_rms_deg / 1e-9);
  }
  take_worst(out, std::abs(errors.ate_max_m / share - 249.9) / (8.0 * kEpsilon * 250.0 / share));
  return out;
}

/// Every built-in sensor as its maker describes it: so many lasers, within its field, each elevation once, all fired
/// within the cycle, from within the housing. A figure counts what differs.
StressFigure beam_table_of(const std::string& name, std::size_t lasers, double low_deg, double high_deg) {
  const auto table = load_beam_table(name);
  if (!table.ok()) return {kInfinity, 0.0};
  StressFigure out;
  const auto count = [&](bool holds) { out.figure += holds ? 0.0 : 1.0; };
  count(table->beams.size() == lasers && !table->rosette);
  std::vector<double> elevations;
  for (const Beam& beam : table->beams) {
    const double e = beam.elevation_rad / kDegree;
    elevations.push_back(e);
    count(e >= low_deg && e <= high_deg);
    count(std::abs(beam.azimuth_offset_rad) <= 15.0 * kDegree);
    count(beam.firing_s >= 0.0 && (table->cycle_s == 0.0 || beam.firing_s < table->cycle_s));
    count(std::abs(beam.origin_up_m) < 0.3 && std::abs(beam.origin_out_m) < 0.1 && std::abs(beam.origin_left_m) < 0.1);
  }
  std::sort(elevations.begin(), elevations.end());
  for (std::size_t k = 1; k < elevations.size(); ++k) count(elevations[k] - elevations[k - 1] > 1e-3);
  count(elevations.back() - elevations.front() > 0.9 * (high_deg - low_deg));
  count(table->last_firing_s() ==
        std::max_element(table->beams.begin(), table->beams.end(), [](const Beam& a, const Beam& b) {
          return a.firing_s < b.firing_s;
        })->firing_s);
  return out;
}

/// A built-in rosette is read to its end: lasers that fire in turn, evenly, one cycle after another without a pause,
/// into a field that is one. A figure counts what differs.
StressFigure rosette_of(const std::string& name) {
  const auto table = load_beam_table(name);
  if (!table.ok() || !table->rosette) return {kInfinity, 0.0};
  const Rosette& rosette = *table->rosette;
  StressFigure out;
  const auto count = [&](bool holds) { out.figure += holds ? 0.0 : 1.0; };
  const auto lasers = static_cast<double>(table->beams.size());
  count(std::abs(table->cycle_s * rosette.points_per_s - lasers) < 4.0 * kEpsilon * lasers);
  for (std::size_t k = 0; k < table->beams.size(); ++k)
    count(std::abs(table->beams[k].firing_s * rosette.points_per_s - static_cast<double>(k)) < 4.0 * kEpsilon * lasers);
  count(rosette.elevation_min_rad > -0.5 * kPi && rosette.elevation_min_rad < rosette.elevation_max_rad &&
        rosette.elevation_max_rad < 0.5 * kPi);
  count(rosette.head_hz > 0.0 && rosette.swing_hz > rosette.head_hz);
  return out;
}

/// A generic sensor has its lasers evenly from end to end: rounding of a product and a sum.
StressFigure grid_of(int lasers) {
  const auto table = load_beam_table("grid:" + std::to_string(lasers) + ":-25:15");
  if (!table.ok()) return {kInfinity, 1.0};
  StressFigure out{0.0, 1.0};
  take_worst(out, table->beams.size() == static_cast<std::size_t>(lasers) ? 0.0 : 1e9);
  for (int k = 0; k < lasers; ++k) {
    const double expected = lasers == 1 ? table->beams[0].elevation_rad / kDegree : -25.0 + 40.0 * k / (lasers - 1);
    take_worst(out, std::abs(table->beams[static_cast<std::size_t>(k)].elevation_rad / kDegree - expected) /
                        (64.0 * kEpsilon * 25.0));
  }
  return out;
}

}  // namespace

std::vector<StressCase> map_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "a map that is wrong by one height everywhere",
           .why = "thresholds, caps and parts of an error that must agree with one another",
           .expected = "every figure in closed form",
           .unit = "",
           .loose = "a sum of so many equal squares may round by as many half epsilons, and hardly does"});
  for (const float up_m : {0.0f, 0.01f, 0.07f, -0.07f, 0.15f, 0.5f, -1.9f, 3.0f})
    rows.add("maps/lifted_by_" + text(static_cast<double>(up_m)) + "_m", [up_m] { return lifted_map(up_m); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "a wall that stands twice in a map",
           .why = "two layers and one thick one have the same spread",
           .expected = "the gap, doubled from 0.1 m on",
           .unit = ""});
  for (const float gap_m : {0.04f, 0.3f, 1.5f})
    rows.add("maps/walls_" + text(static_cast<double>(gap_m)) + "_m_apart", [gap_m] { return doubled_wall(gap_m); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "a map's crispness from a plane to a thick cloud",
           .why = "a determinant of a plane's scatter is nothing",
           .expected = "that of all pairs tried one by one, with variances of (1 mm)^2 at least",
           .unit = ""});
  for (const float thick_m : {0.0f, 1e-4f, 0.05f, 1.0f})
    rows.add("maps/crispness_" + text(static_cast<double>(thick_m)) + "_m_thick",
             [thick_m] { return crispness(thick_m); });
  rows.of({.group = StressGroup::kGeometry,
           .mechanism = "a way that is turned and moved as a whole, near and far",
           .why = "coordinates of 1e7 m less their mean",
           .expected = "found again, to rounding",
           .unit = ""});
  for (const double far_m : {0.0, 100.0, 1e7})
    rows.add("maps/way_moved_" + text(far_m) + "_m", [far_m] { return moved_way(far_m); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "a way that is too long by a share",
           .why = "stretches of a way and of time that end between poses",
           .expected = "errors of that share of each stretch",
           .unit = ""});
  for (const double share : {1e-6, 0.01, 0.5})
    rows.add("maps/way_longer_by_" + text(share), [share] { return stretched_way(share); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "the beams of a built-in sensor",
           .why = "a table of a maker's figures",
           .expected = "as many lasers, as wide a field, each elevation once, fired within the cycle",
           .unit = ""});
  const struct {
    const char* name;
    std::size_t lasers;
    double low_deg, high_deg;
  } sensors[] = {{"vlp16", 16, -15.1, 15.1},
                 {"hdl32e", 32, -30.7, 10.7},
                 {"hdl64e", 64, -25.5, 2.6},
                 {"os1_64", 64, -17.2, 17.2},
                 {"os1_128", 128, -23.0, 23.0}};
  for (const auto& sensor : sensors)
    rows.add(std::string("maps/beams_of_") + sensor.name,
             [sensor] { return beam_table_of(sensor.name, sensor.lasers, sensor.low_deg, sensor.high_deg); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "the beams of a built-in sensor whose pattern does not repeat",
           .why = "a table of keys, each in its line, that must end where it ends",
           .expected = "lasers in turn and evenly, into a field",
           .unit = ""});
  rows.add("maps/rosette_of_mid360", [] { return rosette_of("mid360"); });
  rows.of({.group = StressGroup::kData,
           .mechanism = "the beams of a generic sensor of one laser and of very many",
           .why = "a field divided by one laser less than there are",
           .expected = "evenly from end to end",
           .unit = ""});
  for (const int lasers : {1, 2, 128, 1000})
    rows.add("maps/grid_of_" + std::to_string(lasers), [lasers] { return grid_of(lasers); });
  return rows.take();
}

}  // namespace canyon::lidar
