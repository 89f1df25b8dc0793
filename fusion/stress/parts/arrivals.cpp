// A filter on what arrives, call by call: what is told of each step and of each gap, looks between samples, coasting,
// two clocks, and fixes that stand still.
#include <cmath>
#include <string>
#include <vector>

#include "canyon/core/motion/rotation.h"
#include "canyon/core/stress/looks.h"
#include "canyon/core/units.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/parts/subjects.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/timeline/filter_timeline.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::kInfinity;
using stress::Looks;

ErrorStateFilter begun(const Drive& drive) {
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  return filter;
}

/// What a gap makes less sure is told once, with its length: of a sample that did not arrive its own interval, of
/// missing ones their time; and how long was bridged in all: roundings of a second. Half an interval late or early is
/// no gap.
StressFigure told_of_gaps() {
  Looks looks;
  RestingFilter rest({}, usual_noise(), 100.0);
  FilterTimeline timeline(rest.filter, {.gap_rate_deg_s = 3.0, .gap_force_m_s2 = 0.7});
  std::vector<std::array<double, 3>> told;
  timeline.on_loosened = [&](double theta, double p, double v) { told.push_back({theta, p, v}); };
  int steps = 0, leaves = 0;
  bool even = true;
  timeline.on_step = [&](const ImuSample& s, const NavState& before, const ErrorStateFilter& after) {
    ++steps;
    if (even) looks.near(after.nav_state().t - before.t, s.dt_s, 2e-9);
  };
  timeline.on_leave = [&](const ErrorStateFilter&) { ++leaves; };
  std::vector<double> lengths;
  const auto sample = [&](std::int64_t k) { return rest_sample(rest.truth, k, 100.0); };
  for (std::int64_t k = 0; k < 10; ++k) timeline.add(sample(k));
  looks.right(steps == 10 && leaves == 10 && told.empty());
  ImuSample lost = sample(10);
  lost.lost = true;
  looks.right(timeline.add(lost) == Trouble::kLost);
  lengths.push_back(0.01);
  looks.right(timeline.add(sample(14)) == Trouble::kGap);  // three are missing
  lengths.push_back(0.03);
  looks.near(timeline.bridged_s(), 0.03, 16.0 * kEpsilon);
  looks.right(timeline.add(sample(15)) == Trouble::kNone);
  ImuSample late = sample(16);
  late.t.ns += 4'000'000;
  even = false;  // its ten milliseconds stand for fourteen
  looks.right(timeline.add(late) == Trouble::kNone);
  even = true;
  late = sample(18);
  looks.right(timeline.add(late) == Trouble::kGap);  // 6 ms more
  lengths.push_back(0.006);
  looks.right(timeline.add(sample(100)) == Trouble::kGap);
  lengths.push_back(0.81);
  looks.near(timeline.bridged_s(), 0.03 + 0.006 + 0.81, 16.0 * kEpsilon);
  looks.right(told.size() == lengths.size());
  for (std::size_t i = 0; i < told.size() && i < lengths.size(); ++i) {
    looks.near(told[i][0], 3.0 * kDegree * lengths[i], 64.0 * kEpsilon),
        looks.near(told[i][2], 0.7 * lengths[i], 64.0 * kEpsilon);
    looks.near(told[i][1], 0.5 * 0.7 * lengths[i] * lengths[i], 64.0 * kEpsilon);
  }
  looks.right(timeline.incidents().count(Trouble::kGap) == 3 && timeline.incidents().count(Trouble::kLost) == 1);
  looks.right(timeline.incidents().first(Trouble::kGap) == sample(14).t);
  looks.near(timeline.at() - sample(100).t, 0.0, 1e-9);
  looks.near((timeline.filter().nav_state().p_EU_E - rest.truth.p_EU_E).norm(), 0.0, 1e-6);
  return looks.figure();
}

/// In a gap the last rates hold for a tenth of a second, then nothing turns or pushes: a body that turned evenly has
/// turned by so much, one that was pushed has gained so much speed.
StressFigure held_rates() {
  Looks looks;
  for (const double held_s : {0.0, 0.1, 0.25}) {
    RestingFilter rest({}, usual_noise(), 100.0);
    TimelineConfig config;
    config.held_s = held_s;
    FilterTimeline timeline(rest.filter, config);
    const Vector3d turn(0.0, 0.0, 0.5), push(0.4, 0.0, 0.0);
    const auto sample = [&](std::int64_t k) {
      ImuSample s = rest_sample(rest.truth, k, 100.0);
      s.dtheta_U += 0.01 * turn, s.dv_U += 0.01 * push;
      return s;
    };
    for (std::int64_t k = 0; k < 5; ++k) timeline.add(sample(k));
    const NavState before = timeline.filter().nav_state();
    timeline.add(sample(84));  // 0.79 s missing, then one of 10 ms
    const NavState after = timeline.filter().nav_state();
    const Vector3d turned = so3_log(before.R_EU.conjugate() * after.R_EU);
    // The Earth turns by 6e-5 rad, which rest has in it.
    looks.near(turned.z(), 0.5 * (held_s + 0.01), 1e-6);
    looks.near(turned.head<2>().norm(), 0.0, 1e-5);
    // Speed by the push where it held, along turning axes: within a per cent of the way.
    looks.near((after.v_EU_E - before.v_EU_E).norm(), 0.4 * (held_s + 0.01),
               0.4 * 0.01 * (held_s + 0.01) + 2e-4 + 0.02 * held_s);
    looks.near(after.t - before.t, 0.8, 1e-9);
  }
  return looks.figure();
}

/// Looks at instants between samples, at them, ahead and behind: each once, when all before it has come, with the
/// filter there; none where it is behind. What comes of the filter is that of undivided samples, to 1e-6 of its sigma.
StressFigure looks_between() {
  Looks looks;
  const Drive drive = simulated_drive(4, {.seconds = 2.0, .outage_from_s = 1e9});
  FilterTimeline timeline(begun(drive), {});
  std::vector<double> seen;
  timeline.on_look = [&](const ErrorStateFilter& filter) { seen.push_back(filter.nav_state().t - drive.start); };
  ErrorStateFilter whole = begun(drive);
  std::vector<double> expected;
  std::size_t fix = 0;
  for (std::size_t k = 0; k < drive.imu.size(); ++k) {
    const double end_s = 0.02 * static_cast<double>(k + 1);
    if (k == 10) timeline.look(drive.start + (end_s - 0.013)), expected.push_back(end_s - 0.013);
    if (k == 20) timeline.look(drive.start + end_s), expected.push_back(end_s);
    if (k == 30) timeline.look(drive.start + (end_s + 0.031)), expected.push_back(end_s + 0.031);
    timeline.add(drive.imu[k]);
    whole.predict(drive.imu[k]);
    for (; fix < drive.fixes.size() && drive.fixes[fix].t <= drive.imu[k].t; ++fix)
      timeline.add(AidingMessage(drive.fixes[fix])), whole.update(drive.fixes[fix]);
    if (k == 40) timeline.look(drive.imu[k].t), expected.push_back(end_s);
    if (k == 50) timeline.look(drive.start + (end_s - 0.05));  // over
    looks.right(seen.size() + (k >= 30 && k < 32 ? 1 : 0) == expected.size());
  }
  looks.right(seen.size() == expected.size());
  for (std::size_t i = 0; i < seen.size() && i < expected.size(); ++i) looks.near(seen[i], expected[i], 2e-9);
  const Eigen::VectorXd sigma = whole.covariance().diagonal().cwiseSqrt();
  const auto e = error_of(whole.nav_state(), timeline.filter().nav_state());
  for (int i = 0; i < 9; ++i) looks.near(e[i], 0.0, 1e-3 * sigma[i]);
  looks.right(timeline.at() == whole.nav_state().t && timeline.replays() == 0 && timeline.waiting() == 0);
  return looks.figure();
}

/// Without a unit a filter goes on as it was: along the ground at an even speed, its attitude as it is, in steps of a
/// tenth of a second; as unsure as the noise that it was told of makes it.
StressFigure coasting() {
  Looks looks;
  RestingFilter rest({}, usual_noise(), 100.0);
  const Vector3d v_W(3.0, -4.0, 0.5);
  rest.filter.initialize(GpsTime::from_week_sow(1590, 1000.0), Pose{}, v_W);
  const NavState before = rest.filter.nav_state();
  FilterTimeline timeline(rest.filter, {});
  int steps = 0;
  timeline.on_step = [&](const ImuSample& s, const NavState&, const ErrorStateFilter&) {
    ++steps;
    looks.right(s.dt_s < 0.1501);
  };
  timeline.coast(before.t + 2.03);
  looks.right(steps == 20);
  timeline.coast(before.t + 2.03);
  timeline.coast(before.t + 1.0);
  looks.right(steps == 20 && timeline.bridged_s() == 0.0);
  const NavState& after = timeline.filter().nav_state();
  looks.near(after.t - before.t, 2.03, 1e-9), looks.near(timeline.at() - before.t, 2.03, 1e-9);
  // Gravity and Coriolis are those of each step's start: their gradients over a step.
  looks.near((after.v_EU_E - before.v_EU_E).norm(), 0.0, 1e-4);
  looks.near((after.p_EU_E - before.p_EU_E - 2.03 * before.v_EU_E).norm(), 0.0, 2e-4);
  looks.near(so3_log(before.R_EU.conjugate() * after.R_EU).norm(), 0.0, 1e-9);
  // A fix on the way is taken at its time.
  GnssFix fix = rest.fix(1.0);
  fix.t = before.t + 2.31;
  fix.p_A_E += 2.31 * before.v_EU_E;
  looks.right(timeline.add(AidingMessage(fix)) == Trouble::kAhead && timeline.waiting() == 1);
  std::vector<double> at;
  timeline.on_update = [&](const UpdateReport& report, const ErrorStateFilter& filter) {
    at.push_back(filter.nav_state().t - before.t);
    looks.near(report.t - fix.t, 0.0, 1e-9), looks.right(report.dimension == 3 && report.accepted);
    looks.near(report.innovation.norm(), 0.0, 0.01);
  };
  timeline.coast(before.t + 3.0);
  looks.right(at.size() == 1 && timeline.waiting() == 0);
  if (!at.empty()) looks.near(at.front(), 2.31, 1e-9);
  return looks.figure();
}

/// A unit whose clock is off by a second and a third, told by each sample when it ended by that of the messages: the
/// same estimates to the bit, times by its own clock; late fixes and gaps as ever.
StressFigure two_clocks() {
  int wrong = 0;
  const Drive drive = simulated_drive(7, {.seconds = 4.0, .outage_from_s = 1e9});
  const std::int64_t apart_ns = 1'333'000'000;
  FilterTimeline same(begun(drive), {});
  ErrorStateFilter own = begun(drive);
  own.initialize(GpsTime{drive.start.ns + apart_ns}, drive.X_WB, drive.v_WB_W);
  FilterTimeline other(own, {}, drive.start);
  std::size_t fix = 0;
  for (std::size_t k = 0; k < drive.imu.size(); ++k) {
    if (k >= 110 && k < 113) continue;
    ImuSample sample = drive.imu[k];
    same.add(sample);
    sample.t.ns += apart_ns;
    wrong += other.add(sample, drive.imu[k].t) == (k == 113 ? Trouble::kGap : Trouble::kNone) ? 0 : 1;
    // A fix of a third of a second ago.
    for (; fix < drive.fixes.size() && drive.fixes[fix].t - sample.t < -0.3 - 1.333; ++fix)
      wrong += same.add(AidingMessage(drive.fixes[fix])) == other.add(AidingMessage(drive.fixes[fix])) ? 0 : 1;
  }
  const NavState &a = same.filter().nav_state(), &b = other.filter().nav_state();
  wrong += a.p_EU_E == b.p_EU_E && a.R_EU.coeffs() == b.R_EU.coeffs() && a.v_EU_E == b.v_EU_E &&
                   same.filter().covariance() == other.filter().covariance()
               ? 0
               : 1;
  wrong +=
      b.t.ns == a.t.ns + apart_ns && same.at() == other.at() && other.replays() == same.replays() && same.replays() > 0
          ? 0
          : 1;
  return {1.0 * wrong, 0.0};
}

/// A fix that stands still to the bit while the estimate moves is none; it is one while that is slow, after it has
/// moved, and when it comes of the same instant or before.
StressFigure frozen() {
  int wrong = 0;
  for (const double speed : {0.4, 0.6, 3.0}) {
    RestingFilter rest({}, usual_noise(), 100.0);
    rest.filter.initialize(GpsTime::from_week_sow(1590, 1000.0), Pose{}, {speed, 0.0, 0.0});
    FilterTimeline timeline(rest.filter, {});
    GnssFix fix = rest.fix(5.0);
    const auto at = [&](double t, double moved) {
      for (double now = timeline.at() - rest.truth.t; now < t - 1e-9; now = timeline.at() - rest.truth.t)
        timeline.add(rest_sample(rest.truth, std::llround(now * 100.0), 100.0));
      fix.t = rest.truth.t + t;
      fix.p_A_E.x() += moved;
      return timeline.add(AidingMessage(fix));
    };
    wrong += at(0.1, 0.0) == Trouble::kNone ? 0 : 1;
    wrong += at(0.2, 0.0) == (speed > 0.5 ? Trouble::kFrozen : Trouble::kNone) ? 0 : 1;
    wrong += at(0.3, 0.01) == Trouble::kNone ? 0 : 1;
    wrong += at(0.4, 0.0) == (speed > 0.5 ? Trouble::kFrozen : Trouble::kNone) ? 0 : 1;
    wrong += timeline.incidents().count(Trouble::kFrozen) == (speed > 0.5 ? 2 : 0) ? 0 : 1;
  }
  return {1.0 * wrong, 0.0};
}

/// Where stamps are said to be off by a state, a fix is due at its stamp and that; messages with numbers that are none
/// are left out, each kind.
StressFigure offsets_and_numbers() {
  Looks looks;
  const Drive drive =
      simulated_drive(3, {.seconds = 1.0, .outage_from_s = 1e9, .keys = "states = [\"biases\", \"time_offset\"]"});
  FilterTimeline timeline(begun(drive), {});
  for (const ImuSample& s : drive.imu) timeline.add(s);
  const double nan = std::nan("");
  const auto none = [&](const AidingMessage& message) { looks.right(timeline.add(message) == Trouble::kNotFinite); };
  const GpsTime t = drive.imu.back().t;
  none(OdometerSample{.t = t, .dt_s = 0.1, .ticks = 1, .speed_m_s = nan}),
      none(OdometerSample{.t = t, .dt_s = 0.0, .ticks = 1, .speed_m_s = 1.0});
  none(OdometerSample{.t = t, .dt_s = kInfinity, .ticks = 1, .speed_m_s = 1.0}), none(BarometerSample{t, nan}),
      none(MagnetometerSample{t, {0.0, nan, 0.0}});
  none(HeadingSample{t, nan, 0.1}), none(HeadingSample{t, 0.1, nan}), none(HeadingSample{t, 0.1, 0.0});
  RelativePose moved{.source = t, .target = t, .X_TS = {}, .covariance = Matrix6d::Identity()};
  moved.covariance(3, 3) = -1.0;
  none(moved);
  moved.covariance = Matrix6d::Identity(), moved.X_TS.p.y() = nan;
  none(moved);
  PoseInMap placed{.t = t, .X_WB = {}, .covariance = Matrix6d::Identity()};
  placed.X_WB.R.coeffs()[1] = nan;
  none(placed);
  placed.X_WB = {}, placed.covariance(0, 0) = 0.0;
  none(placed);
  ImuSample bad = drive.imu.back();
  bad.t = bad.t + 0.02;
  for (const double dt : {0.0, -0.02, nan, kInfinity}) {
    bad.dt_s = dt;
    looks.right(timeline.add(bad) == Trouble::kNotFinite);
  }
  looks.right(timeline.incidents().count(Trouble::kNotFinite) == 16);
  // A fix that is due later than its stamp says waits, by what it is told or by the state.
  GnssFix fix = drive.fixes.back();
  fix.t = t + -0.03;
  looks.right(timeline.add(AidingMessage(fix), t + 0.01) == Trouble::kAhead && timeline.waiting() == 1);
  Incidents all, more;
  all.add(Trouble::kGap, t), more.add(Trouble::kLost, t + 1.0), more.add(Trouble::kGap, t + 2.0);
  all.add(more);
  looks.right(all.count(Trouble::kGap) == 2 && all.count(Trouble::kLost) == 1 && all.first(Trouble::kGap) == t &&
              all.first(Trouble::kLost) == t + 1.0);
  looks.right(all.text() == "2 x gap in the IMU's samples (first at " + t.iso() +
                                "), 1 x IMU sample repeated in place of a lost one (first at " + (t + 1.0).iso() + ")");
  return looks.figure();
}

}  // namespace

std::vector<StressCase> arrival_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "what a filter on a timeline tells, and how it goes on",
           "a gap of the whole interval, a look before its time, a step that is not told",
           "lengths, instants and ways by hand: stamps of a nanosecond", "of the bound"});
  rows.add("arrivals/told_of_gaps", told_of_gaps)
      .add("arrivals/held_rates", held_rates)
      .add("arrivals/looks_between", looks_between);
  rows.add("arrivals/coasting", coasting).add("arrivals/offsets_and_numbers", offsets_and_numbers);
  rows.of({StressGroup::kData, "two clocks, and fixes that stand still",
           "a time of the other clock, a fix that is taken for frozen at rest",
           "the same bits, and each trouble by name", "wrong"});
  rows.add("arrivals/two_clocks", two_clocks).add("arrivals/frozen", frozen);
  return rows.take();
}

}  // namespace canyon::fusion
