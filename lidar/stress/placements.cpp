// Where a turning head and a moving sensor let each shot begin and point, against the definitions.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/motion/trajectory.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/lidar/beam/aim.h"
#include "canyon/lidar/beam/beam_table.h"
#include "canyon/lidar/beam/firing_pattern.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/lidar/sweep_motion.h"

namespace canyon::lidar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using stress::kHalfUlp;
using stress::Looks;
const GpsTime kStamp{1'200'000'000'000'000'000};

/// Poses at `spacing_s` on a screw motion, from -0.15 s to 0.02 s.
Trajectory screwed(const Pose& at_stamp, const Vector6d& per_s, double spacing_s) {
  Trajectory out;
  for (int k = -static_cast<int>(std::lround(0.15 / spacing_s)); k * spacing_s <= 0.0200001; ++k)
    out.append({kStamp + k * spacing_s, at_stamp * Pose::exp(per_s * (k * spacing_s))});
  return out;
}

/// Sixteen placements at once, with any step, over any number of nodes, before the first and after the last: each the
/// pose on the screw to what a chord may be off, 3e-8 rad and 1 um, and single precision; the rates those of the screw,
/// of a velocity by what it changes within a chord. One by one the same, in any order of times.
StressFigure placed_at_all_times(double deg_s, double speed_m_s, double spacing_s) {
  Looks looks;
  Vector6d per_s;
  per_s << deg_s * kDegree * Vector3d(0.3, -0.5, 0.81).normalized(), speed_m_s * Vector3d(0.9, 0.1, -0.4);
  const Pose begin{rotation_from({.yaw_rad = 1.0, .pitch_rad = 0.2, .roll_rad = -0.1}), {30.0, -12.0, 4.0}},
      X_BL{rotation_from({.yaw_rad = -0.5, .pitch_rad = 0.1, .roll_rad = 0.3}), {0.5, -0.2, 1.6}},
      X_RW{Eigen::Quaterniond::Identity(), {-28.0, 10.0, 0.0}};
  const Trajectory motion = screwed(begin, per_s, spacing_s);
  const double first_s = -0.1013, last_s = 0.0131;
  const SweepMotion sweep(motion, kStamp, first_s, last_s, X_RW, X_BL);
  looks.right(sweep.covers(first_s) && sweep.covers(last_s) && sweep.covers(first_s - 0.5e-8) &&
              !sweep.covers(first_s - 3e-8) && sweep.covers(last_s + 0.5e-8) && !sweep.covers(last_s + 3e-8));
  const auto exact = [&](double t) { return X_RW * begin * Pose::exp(per_s * std::clamp(t, first_s, last_s)) * X_BL; };
  const Vector3d w_B = per_s.head<3>(), w_L = X_BL.R.conjugate() * w_B;
  const double w = w_B.norm(), fastest = per_s.tail<3>().norm() + w * X_BL.p.norm(), bend = w * fastest;
  const double chord_rad = 3e-8 + 1e-10, chord_m = 1.01e-6;
  const RandomStream draws(3, "stress.placements");
  std::size_t hint = 0, alone = 0;
  for (std::uint64_t k = 0; k < 240; ++k) {
    const double time_s = draws.uniform(-0.11, 0.014, 0, k), step_s = std::pow(10.0, draws.uniform(-6.0, -2.3, 1, k));
    PlacementPacket out;
    sweep.placements(time_s, step_s, hint, out);
    for (std::size_t i = 0; i < PlacementPacket::kShots; ++i) {
      const double t = time_s + static_cast<double>(i) * step_s;
      const Pose X = exact(t);
      const Matrix3d R = X.R.toRotationMatrix();
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
          looks.near(out.R[3 * row + column][i], R(row, column), chord_rad + 2.0 * kHalfUlp);
        looks.near(out.p[row][i], X.p[row], chord_m + 2.0 * kHalfUlp * (std::abs(X.p[row]) + 1.0));
      }
      if (!sweep.covers(t)) continue;
      const SweepMotion::Placement one = sweep.at(t, alone);
      looks.near((one.R - R).norm(), 0.0, 3.0 * chord_rad), looks.near((one.p - X.p).norm(), 0.0, 2.0 * chord_m);
      looks.near((one * Vector3d(3, 4, 5) - X * Vector3d(3, 4, 5)).norm(), 0.0, 2.0 * chord_m + 20.0 * chord_rad);
    }
    // At the ninth shot. A chord that is 1 um off at most lasts sqrt(8 um / bend), in which a velocity changes by bend
    // times that; nodes are no farther apart than poses, and no closer than 5 us.
    const double t = time_s + 8.0 * step_s;
    const double lasts_s = std::min(spacing_s, std::max(5e-6, std::sqrt(8e-6 / std::max(bend, 1e-12))));
    const Vector3d v_W = (X_RW * begin * Pose::exp(per_s * std::clamp(t, first_s, last_s))).R *
                         (Vector3d(per_s.tail<3>()) + w_B.cross(X_BL.p));
    for (int a = 0; a < 3; ++a) {
      looks.near(out.w_WL_L[a], w_L[a], 1e-6 * w + 1e-9 + w * std::pow(w * lasts_s, 2));
      looks.near(out.v_WL_W[a], v_W[a], bend * lasts_s + 1e-6 * fastest + 1e-9);
    }
  }
  return looks.figure();
}

/// Of one pose it is that one at all times, at rest; of none, or of a motion that begins later, nothing.
StressFigure one_pose() {
  Looks looks;
  Trajectory one;
  const Pose X_WB{rotation_from({.yaw_rad = 0.5, .pitch_rad = 0.1, .roll_rad = 0.2}), {1.0, 2.0, 3.0}};
  one.append({kStamp - 0.05, X_WB});
  const SweepMotion sweep(one, kStamp, -0.1, 0.0, Pose{}, Pose{});
  looks.right(sweep.covers(-0.05) && !sweep.covers(-0.04) && !sweep.covers(-0.06));
  PlacementPacket out;
  std::size_t hint = 0;
  sweep.placements(-0.07, 1e-3, hint, out);
  const Matrix3d R = X_WB.R.toRotationMatrix();
  for (std::size_t i = 0; i < PlacementPacket::kShots; ++i)
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) looks.near(out.R[3 * row + column][i], R(row, column), kHalfUlp);
      looks.near(out.p[row][i], X_WB.p[row], 1e-300);
      looks.right(out.w_WL_L[row] == 0.0f && out.v_WL_W[row] == 0.0f);
    }
  looks.near((sweep.at(-0.05, hint).p - X_WB.p).norm(), 0.0, 1e-300);
  looks.right(!SweepMotion(Trajectory{}, kStamp, -0.1, 0.0, Pose{}, Pose{}).covers(-0.05));
  looks.right(!SweepMotion(one, kStamp, -0.04, 0.0, Pose{}, Pose{}).covers(-0.02));
  looks.right(stress::not_refused([&] { sweep.at(-0.02, hint); }) == 0);
  return looks.figure();
}

/// A beam of a table in a cycle of a scan by its definition: the head turns clockwise from -x, once a period; a laser
/// fires later by its own time, beside the head by its own angle, from its own place.
struct Aimed {
  Vector3d origin, direction;
};
Aimed aimed_by_definition(const BeamTable& table, std::size_t laser, double head_turns, double since_first_s) {
  const Beam& beam = table.beams[laser];
  if (table.rosette) {
    const Rosette& r = *table.rosette;
    const double t = since_first_s + beam.firing_s, lasers = static_cast<double>(table.beams.size());
    const double azimuth = 2.0 * kPi * std::fmod(t * r.head_hz, 1.0);
    const double swing = 2.0 * kPi * std::fmod(t * r.swing_hz + static_cast<double>(laser) / lasers, 1.0);
    const double elevation =
        r.elevation_min_rad + 0.5 * (r.elevation_max_rad - r.elevation_min_rad) * (1.0 + std::sin(swing));
    return {Vector3d::Zero(),
            {-std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)}};
  }
  const double turn = 2.0 * kPi * head_turns, azimuth = turn + beam.azimuth_offset_rad;
  const Vector3d ahead(-std::cos(turn), std::sin(turn), 0.0), left(-std::sin(turn), -std::cos(turn), 0.0);
  return {beam.origin_out_m * ahead + beam.origin_left_m * left + Vector3d(0, 0, beam.origin_up_m),
          {-std::cos(azimuth) * std::cos(beam.elevation_rad), std::sin(azimuth) * std::cos(beam.elevation_rad),
           std::sin(beam.elevation_rad)}};
}

/// Every laser of a table, cycle by cycle of a scan, aimed, and fired from a sensor that turns and moves, a little
/// after the time of its place: to first order in that. Single precision of six operations, and of whole turns of a
/// rosette over its scans.
StressFigure aimed_and_fired(const std::string& beams, std::size_t steps, std::int64_t index) {
  Looks looks;
  const auto table = load_beam_table(beams);
  looks.right(table.ok());
  if (!table) return looks.figure();
  const double rate_hz = 10.0, period_s = 0.1;
  const FiringPattern pattern(*table, rate_hz, steps);
  const auto sweep = pattern.sweep(index);
  const double step_s = steps > 0 ? period_s / static_cast<double>(steps) : table->cycle_s;
  looks.near(pattern.step_s(), step_s, 1e-15), looks.right(pattern.lasers() == table->beams.size());
  looks.near(pattern.overlap_s(), steps > 0 ? 0.0 : step_s, 1e-300);
  double last_s = 0.0;
  for (const Beam& beam : table->beams) last_s = worse(last_s, beam.firing_s);
  const auto scan = static_cast<double>(index);
  if (steps > 0) {
    looks.right(sweep.cycles == steps && sweep.first_cycle == static_cast<std::uint64_t>(index) * steps);
    looks.near(sweep.start_s, -period_s + step_s - last_s, 1e-12);
  } else {
    // Those whose last firing lies in (index, index + 1] periods.
    const auto ends = [&](double m) { return m * step_s + last_s; };
    const auto m = static_cast<double>(sweep.first_cycle);
    const double end = m + static_cast<double>(sweep.cycles);
    looks.right(ends(m) > scan * period_s - 2e-9 && (m == 0.0 || ends(m - 1.0) <= scan * period_s + 2e-9));
    looks.right(ends(end) > (scan + 1.0) * period_s - 2e-9 && ends(end - 1.0) <= (scan + 1.0) * period_s + 2e-9);
    looks.near(sweep.start_s, m * step_s - (scan + 1.0) * period_s, 1e-9);
  }
  PlacementPacket at[2];
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < 16; ++i) {
      const double t = 0.02 * static_cast<double>(16 * k + i);
      const Matrix3d R = rotation_from({.yaw_rad = t, .pitch_rad = 0.1 + t, .roll_rad = -t}).toRotationMatrix();
      for (int j = 0; j < 9; ++j) at[k].R[j][i] = static_cast<float>(R(j / 3, j % 3));
      for (int j = 0; j < 3; ++j) at[k].p[j][i] = static_cast<float>(2.0 * j + t);
    }
    for (int j = 0; j < 3; ++j)
      at[k].w_WL_L[j] = 3.0f - 2.0f * static_cast<float>(j), at[k].v_WL_W[j] = 7.0f - 5.0f * static_cast<float>(j);
  }
  const Vector3d w(3, 1, -1), v(7, 2, -3);
  const float late_s = 4e-4f;
  for (std::size_t laser = 0; laser < pattern.lasers(); ++laser)
    for (std::size_t cycle = 0; cycle + 32 <= sweep.cycles; cycle += 192) {
      AimPacket aim[2];
      scene::RayPacket fired[2], placed[2];
      pattern.aim(sweep, laser, cycle, aim[0]), pattern.aim(sweep, laser, cycle + 16, aim[1]);
      pattern.fire(sweep, laser, cycle, at, late_s, 66.0f, fired);
      for (std::size_t k = 0; k < 2; ++k) place_shots(aim[k], at[k], late_s, 66.0f, placed[k]);
      for (std::size_t n = 0; n < 32; ++n) {
        const std::size_t k = n / 16, i = n % 16;
        const double t = static_cast<double>(cycle + n) * step_s;
        const double firing_s = table->beams[laser].firing_s;
        // Cycles that start with the scan begin at the seam; others where the head is then.
        const double turns =
            steps > 0 ? (t + firing_s) / period_s
                      : std::fmod((static_cast<double>(sweep.first_cycle) * step_s + t + firing_s) / period_s, 1.0);
        const double since_s = steps > 0 ? scan * period_s + t : static_cast<double>(sweep.first_cycle) * step_s + t;
        const Aimed exact = aimed_by_definition(*table, laser, turns, since_s);
        const Vector3d o(aim[k].origin_x[i], aim[k].origin_y[i], aim[k].origin_z[i]),
            d(aim[k].direction_x[i], aim[k].direction_y[i], aim[k].direction_z[i]);
        const double grain = 8.0 * kHalfUlp + 1e-12 * since_s * 200.0;
        looks.near((d - exact.direction).norm(), 0.0, grain), looks.near((o - exact.origin).norm(), 0.0, grain * 0.2);
        Matrix3d R;
        for (int j = 0; j < 9; ++j) R(j / 3, j % 3) = at[k].R[j][i];
        const Vector3d p(at[k].p[0][i], at[k].p[1][i], at[k].p[2][i]);
        const double late = static_cast<double>(late_s);
        const Vector3d from = p + late * v + R * o, along = R * (d + late * w.cross(d));
        looks.near((Vector3d(placed[k].origin_x[i], placed[k].origin_y[i], placed[k].origin_z[i]) - from).norm(), 0.0,
                   16.0 * kHalfUlp * 8.0);
        looks.near(
            (Vector3d(placed[k].direction_x[i], placed[k].direction_y[i], placed[k].direction_z[i]) - along).norm(),
            0.0, 16.0 * kHalfUlp);
        looks.right(placed[k].max_m[i] == 66.0f && fired[k].max_m[i] == 66.0f);
        looks.right(
            fired[k].origin_x[i] == placed[k].origin_x[i] && fired[k].origin_y[i] == placed[k].origin_y[i] &&
            fired[k].origin_z[i] == placed[k].origin_z[i] && fired[k].direction_x[i] == placed[k].direction_x[i] &&
            fired[k].direction_y[i] == placed[k].direction_y[i] && fired[k].direction_z[i] == placed[k].direction_z[i]);
      }
    }
  looks.right(stress::not_refused([&] { pattern.sweep(-1); }) == 0);
  return looks.figure();
}

}  // namespace

std::vector<StressCase> placement_cases() {
  StressRows rows;
  rows.of({StressGroup::kStiff, "sixteen places of a moving sensor at once",
           "a node before for the one after, a rate of the other segment, times before the first or after the last",
           "the screw it moves on: what a chord may be off, and single precision", "of the bound"});
  struct Screw {
    double deg_s, m_s, spacing_s;
    const char* name;
  };
  for (const Screw& s :
       {Screw{0.0, 0.0, 0.01, "rest"}, Screw{0.0, 30.0, 0.005, "straight"}, Screw{1.0, 2.0, 0.0025, "slow"},
        Screw{90.0, 15.0, 0.01, "90_deg_s"}, Screw{1500.0, 20.0, 0.005, "1500_deg_s"}})
    rows.add(std::string("placements/at_") + s.name, [s] { return placed_at_all_times(s.deg_s, s.m_s, s.spacing_s); });
  rows.add("placements/of_one_pose", one_pose);
  rows.of(
      {StressGroup::kGeometry, "where each laser of a table points, and is fired",
       "a head that turns the other way, a laser's time for another's, a turn about the wrong axis while it is late",
       "definitions, to first order of the lateness: single precision", "of the bound"});
  struct Table {
    const char* beams;
    std::size_t steps;
  };
  for (const Table& t : {Table{"vlp16", 1800}, Table{"vlp16", 0}, Table{"hdl64e", 900}, Table{"os1_64", 1024},
                         Table{"mid360", 0}, Table{"grid:5:-10:10", 300}})
    for (const std::int64_t index : {0, 3, 36000})
      rows.add(std::string("placements/") + (t.steps > 0 ? "" : "free_") +
                   (std::string(t.beams).find(':') == std::string::npos ? t.beams : "grid") + "_in_scan_" +
                   std::to_string(index),
               [t, index] { return aimed_and_fired(t.beams, t.steps, index); });
  return rows.take();
}

}  // namespace canyon::lidar
