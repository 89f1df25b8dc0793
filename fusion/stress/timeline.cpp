// What reaches a filter late, early, twice, in gaps.
#include <algorithm>
#include <variant>
#include <vector>

#include "canyon/core/stress_rows.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/stress/simulated_drive.h"
#include "canyon/fusion/stress/subjects.h"
#include "canyon/fusion/timeline/filter_timeline.h"

namespace canyon::fusion {
namespace {

using Eigen::Vector3d;
using stress::kEpsilon;
using stress::Worst;

struct Arrival {
  double at_s;
  std::variant<ImuSample, AidingMessage> what;
};

ErrorStateFilter started(const Drive& drive) {
  ErrorStateFilter filter(drive.config, drive.noise, drive.frame, drive.lever_U_B, drive.lever_A_B);
  filter.initialize(drive.start, drive.X_WB, drive.v_WB_W);
  return filter;
}

/// Fixes of a second each, in the middle of a sample, that come `late_s` later.
std::vector<Arrival> arrivals(const Drive& drive, double late_s) {
  std::vector<Arrival> out;
  for (const ImuSample& imu : drive.imu) out.push_back({imu.t - drive.start, imu});
  for (GnssFix fix : drive.fixes) {
    fix.t.ns -= 7'000'000;
    out.push_back({fix.t - drive.start + late_s, AidingMessage(fix)});
  }
  std::stable_sort(out.begin(), out.end(), [](const Arrival& a, const Arrival& b) { return a.at_s < b.at_s; });
  return out;
}

FilterTimeline taken(const std::vector<Arrival>& all, const Drive& drive, const TimelineConfig& config = {}) {
  FilterTimeline timeline(started(drive), config);
  for (const Arrival& a : all) std::visit([&](const auto& what) { timeline.add(what); }, a.what);
  return timeline;
}

int differ(const FilterTimeline& a, const FilterTimeline& b) {
  const NavState &x = a.filter().nav_state(), &y = b.filter().nav_state();
  return (x.p_EU_E == y.p_EU_E ? 0 : 1) + (x.R_EU.coeffs() == y.R_EU.coeffs() ? 0 : 1) +
         (a.filter().covariance() == b.filter().covariance() ? 0 : 1);
}

/// In time, late by less than is waited for, and all of them ahead of the IMU: the same bits once all have come; each
/// late one is a replay and each early one told.
StressFigure any_order(const std::string& keys) {
  const Drive drive = simulated_drive(4, {.seconds = 6.4, .outage_from_s = 1e9, .keys = keys.c_str()});
  const auto fixes = static_cast<std::int64_t>(drive.fixes.size());
  const FilterTimeline in_time = taken(arrivals(drive, 0.0), drive);
  std::int64_t wrong = in_time.replays();
  for (const double late_s : {0.013, 0.333, 0.45}) {
    const FilterTimeline late = taken(arrivals(drive, late_s), drive);
    wrong += differ(in_time, late) + std::abs(late.replays() - fixes);
    wrong += late.incidents().text().empty() ? 0 : 1;
  }
  const FilterTimeline early = taken(arrivals(drive, -0.4), drive);
  wrong += differ(in_time, early) + std::abs(early.incidents().count(Trouble::kAhead) - fixes);
  const FilterTimeline too_late = taken(arrivals(drive, 1.3), drive, {.wait_s = 0.5});
  wrong += std::abs(too_late.incidents().count(Trouble::kTooLate) - (fixes - 1));  // the last one has not come by then
  return {static_cast<double>(wrong), 0.0};
}

/// All messages of two seconds come before any sample of theirs, in any order: fixes, wheels and pressures. None of
/// them is before its time, so none makes the filter go back; each is told, all wait, and what comes of them is to the
/// bit what comes of them in time.
StressFigure all_ahead(int turn) {
  const Drive drive =
      simulated_drive(4, {.seconds = 6.0,
                          .outage_from_s = 1e9,
                          .keys = "filter = \"vehicle\"\nmeasurements = [\"position\", \"odometer\", \"barometer\"]"});
  std::vector<AidingMessage> messages;
  for (std::int64_t k = 1; k <= 30; ++k) {
    // Beside the samples and at them, no two at one time.
    const GpsTime t{drive.start.ns + 200'000'000 * k - (k % 3) * 7'000'000};
    const auto& at = drive.truth[static_cast<std::size_t>(10 * k)];
    if (k % 3 == 0) {
      GnssFix fix;
      fix.t = t;
      fix.status = FixStatus::kSingle;
      fix.p_A_E = at.p_EU_E + at.R_EU * (drive.lever_A_B - drive.lever_U_B);
      fix.covariance_E = Eigen::Matrix3d::Identity();
      messages.emplace_back(fix);
    } else if (k % 3 == 1) {
      OdometerSample wheel;
      wheel.t = t;
      wheel.dt_s = 0.1;
      wheel.speed_m_s = (at.R_EU.conjugate() * at.v_EU_E).x();
      messages.emplace_back(wheel);
    } else {
      BarometerSample air;
      air.t = t;
      air.pressure_pa = 98000.0;
      messages.emplace_back(air);
    }
  }
  const auto run = [&](const auto& order, double before_s) {
    FilterTimeline timeline(started(drive), {});
    std::size_t next = 0;
    std::int64_t wrong = 0;
    for (const ImuSample& sample : drive.imu) {
      // Blocks of ten messages, two seconds, each given in its order.
      while (next < messages.size() &&
             (before_s == 0.0 ? time_of(messages[next]) <= sample.t
                              : time_of(messages[next / 10 * 10]) - sample.t < 0.06 + before_s)) {
        if (before_s == 0.0) {
          timeline.add(messages[next++]);
          continue;
        }
        const std::size_t waiting = timeline.waiting();
        for (std::size_t i = 0; i < 10; ++i) {
          wrong += timeline.add(messages[next + order(i)]) == Trouble::kAhead ? 0 : 1;
          wrong += timeline.waiting() == waiting + i + 1 ? 0 : 1;
        }
        next += 10;
      }
      timeline.add(sample);
    }
    wrong += timeline.replays() + static_cast<std::int64_t>(timeline.waiting());
    return std::pair(std::move(timeline), wrong);
  };
  const auto [in_time, none] = run([](std::size_t i) { return i; }, 0.0);
  const auto [ahead, wrong] = run([turn](std::size_t i) { return (i * static_cast<std::size_t>(turn) + 9) % 10; }, 0.1);
  return {static_cast<double>(differ(in_time, ahead) + wrong + none), 0.0};
}

/// A gap of a vehicle that rests: what it is less sure by on each axis is the stated rate and force times the gap, half
/// the force by its square, beside what prediction over the gap makes by itself. Attitudes are known to 0.1 degrees,
/// and gravity's pull moves those into velocity and place: prediction alone over the same time says how far.
StressFigure gap(double gap_s) {
  const TimelineConfig config{.gap_rate_deg_s = 0.5, .gap_force_m_s2 = 3.0};
  RestingFilter rest({}, usual_noise(), 100.0), alone({}, usual_noise(), 100.0);
  FilterTimeline timeline(rest.filter, config);
  const auto missing = static_cast<std::int64_t>(std::llround(100.0 * gap_s));
  Worst worst;
  for (std::int64_t k = 0; k < 200; ++k) {
    timeline.add(rest_sample(rest.truth, k, 100.0));
    alone.predict();
  }
  worst.look((timeline.filter().covariance() - alone.filter.covariance()).cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
             1e-300);
  const Trouble told = timeline.add(rest_sample(rest.truth, 200 + missing, 100.0));
  worst.look(told == Trouble::kGap ? 0.0 : stress::kInfinity, 1.0);
  for (std::int64_t k = 0; k <= missing; ++k) alone.predict();
  const auto more = (timeline.filter().covariance() - alone.filter.covariance()).eval();
  const double pushed = 3.0 * gap_s,
               expected[] = {std::pow(0.5 * kDegree * gap_s, 2), std::pow(0.5 * pushed * gap_s, 2), pushed * pushed};
  // The sample after it moves the place by the new velocity's 10 ms, and the velocity by the new tilt; the white noise
  // over steps of other lengths is the same, and what the known part of the covariance makes meanwhile differs by the
  // order of the steps.
  const double known_p = alone.filter.covariance().diagonal().segment<3>(3).maxCoeff<Eigen::PropagateNaN>(),
               known_v = alone.filter.covariance().diagonal().segment<3>(6).maxCoeff<Eigen::PropagateNaN>();
  const double after[] = {0.0, 0.01 * 0.01 * expected[2], std::pow(9.82 * 0.01, 2) * expected[0]};
  const double known[] = {1e-6 * expected[0], 1e-3 * known_p, 1e-3 * known_v};
  for (int block = 0; block < 3; ++block)
    for (int axis = 0; axis < 3; ++axis) {
      const double part = more(3 * block + axis, 3 * block + axis) - expected[block];
      worst.look(part, 2.0 * after[block] + known[block] + 1e-9 * expected[block]);
    }
  const NavState &here = timeline.filter().nav_state(), &there = alone.filter.nav_state();
  // At rest nothing is lost: what holds, and what coasts, is rest; gravity rounds.
  worst.look((here.p_EU_E - there.p_EU_E).norm(), 1e-7 * std::max(1.0, gap_s * gap_s));
  return worst.figure();
}

/// Each trouble is told, once, and none of it changes what is estimated.
StressFigure troubles() {
  RestingFilter rest({}, usual_noise(), 100.0);
  FilterTimeline timeline(rest.filter, {});
  std::int64_t k = 0;
  const auto ahead = [&](int samples) {
    for (int i = 0; i < samples; ++i) timeline.add(rest_sample(rest.truth, k++, 100.0));
  };
  ahead(100);
  int wrong = 0;
  const auto refused = [&](const auto& what, Trouble trouble) {
    const FilterTimeline before = timeline;
    const std::int64_t count = timeline.incidents().count(trouble);
    wrong += timeline.add(what) == trouble && timeline.incidents().count(trouble) == count + 1 ? 0 : 1;
    wrong += differ(timeline, before);
  };
  ImuSample sample = rest_sample(rest.truth, k, 100.0);
  sample.dv_U.y() = std::nan("");
  refused(sample, Trouble::kNotFinite);
  refused(rest_sample(rest.truth, k - 1, 100.0), Trouble::kDuplicate);
  refused(rest_sample(rest.truth, k - 5, 100.0), Trouble::kReversed);
  GnssFix fix = rest.fix(1.0);
  fix.t = timeline.filter().nav_state().t;
  wrong += timeline.add(AidingMessage(fix)) == Trouble::kNone ? 0 : 1;
  refused(AidingMessage(fix), Trouble::kDuplicate);
  GnssFix bad = fix;
  bad.t.ns -= 30'000'000;
  bad.covariance_E(1, 1) = -1.0;
  refused(AidingMessage(bad), Trouble::kNotFinite);
  GnssFix ahead_of = fix;
  ahead_of.t.ns += 50'000'000;
  refused(AidingMessage(ahead_of), Trouble::kAhead);
  ahead(300);
  GnssFix old = fix;
  old.t.ns -= 500'000'000;
  refused(AidingMessage(old), Trouble::kTooLate);
  GnssFix none = fix;
  none.status = FixStatus::kNone;
  none.p_A_E.setConstant(std::nan(""));
  wrong += timeline.add(AidingMessage(none)) == Trouble::kNone ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// Samples that overlap by a share of themselves, and fixes at a fifth, a half and all of a sample: the way is that of
/// the samples as they are, to what a linear part of a step leaves of a resting body, and 100 roundings.
StressFigure divided() {
  RestingFilter rest({}, usual_noise(), 100.0), whole({}, usual_noise(), 100.0);
  FilterTimeline timeline(rest.filter, {});
  Worst worst;
  for (std::int64_t k = 0; k < 100; ++k) {
    ImuSample sample = rest_sample(rest.truth, k, 100.0);
    if (k % 10 == 3) {  // begins a fifth of it too early, or a third too late, which the next one has again
      sample.dt_s *= 1.2;
      sample.dtheta_U *= 1.2;
      sample.dv_U *= 1.2;
    }
    timeline.add(sample);
    whole.predict();
    if (k % 20 == 19) {
      GnssFix fix = rest.fix(1.0);
      fix.t.ns = rest.truth.t.ns + (k + 1) * 10'000'000 - 2'000'000 * (k / 20);
      timeline.add(AidingMessage(fix));
      GnssFix same = rest.fix(1.0);
      same.t = whole.filter.nav_state().t;
      whole.filter.update(same);
    }
  }
  const auto P = timeline.filter().covariance(), Q = whole.filter.covariance();
  // Covariances where fixes are up to 8 ms early: of a metre's fix, 5 cm/s and 0.1 degrees within 0.8 s nothing more
  // than 8 ms of the velocity's variance of a second.
  for (int i = 3; i < 6; ++i) worst.look(P(i, i) - Q(i, i), 2.0 * 0.008 * Q(i, i));
  worst.look((timeline.filter().nav_state().p_EU_E - whole.filter.nav_state().p_EU_E).norm(), 100.0 * kEpsilon * 6.4e6);
  worst.look(timeline.filter().nav_state().t - whole.filter.nav_state().t, 1e-9);
  return worst.figure();
}

}  // namespace

std::vector<StressCase> timeline_cases() {
  const auto group = StressGroup::kData;
  const StressMechanism order{group, "fixes that come late, early and in between samples",
                              "a copy to go back to that is not what was there, or a share of a sample taken twice",
                              "the same bits as in time, and each trouble counted", "differences"};
  const StressMechanism bridged{group, "a gap in an IMU's samples",
                                "the gap's noise per sample instead of over the gap, or of the wrong power of it",
                                "rate, force and half its square times the gap beside prediction; one sample's more",
                                "of the bound"};
  const StressMechanism trouble{group, "samples and fixes of a wrong time or number, on a timeline",
                                "one of them moves the filter or ends it", "told by its name, and nothing changed",
                                "differences"};
  const StressMechanism shares{group, "samples and fixes that divide one another",
                               "a part of an interval that counts twice, or is lost",
                               "the way of the undivided samples, to roundings", "of the bound"};
  StressRows rows;
  rows.of(order)
      .add("timeline/late_and_early", [] { return any_order("states = [\"biases\", \"gains\"]"); })
      .add("timeline/late_and_early_with_all_of_a_vehicle",
           [] { return any_order("filter = \"vehicle\"\nmeasurements = [\"position\", \"non_holonomic\"]"); });
  for (const int turn : {1, 3, 7, 9})
    rows.add("timeline/all_ahead_in_turns_of_" + std::to_string(turn), [turn] { return all_ahead(turn); });
  for (const double gap_s : {0.02, 0.5, 5.0, 60.0})
    rows.of(bridged).add("timeline/gap_of_" + stress::text(gap_s) + "_s", [gap_s] { return gap(gap_s); });
  rows.of(trouble).add("timeline/each_trouble", troubles);
  rows.of(shares).add("timeline/divided_samples", divided);
  return rows.take();
}

}  // namespace canyon::fusion
