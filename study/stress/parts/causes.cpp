// Why a run failed, who has which share in an error, and by which order errors fall: on what was laid out by hand.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "canyon/core/stress/looks.h"
#include "canyon/study/causes/causes.h"
#include "canyon/study/causes/events.h"
#include "canyon/study/registration_error/shapley.h"
#include "canyon/study/statistics/proportions.h"
#include "canyon/study/stress/parts/subjects.h"
#include "canyon/study/tolerance/tolerance.h"
#include "canyon/study/tradeoff/measuring/front.h"
#include "canyon/study/tradeoff/measuring/observed_order.h"

namespace canyon::study {
namespace {

using stress::Looks;

/// Chains of events before a failure, by their gaps of 10 s and at most 60 s; Holm's steps; tolerances that fall.
StressFigure chains_and_steps() {
  Looks looks;
  const auto starts = [&](std::vector<Event> events, double failed_s, double expected_s) {
    looks.near(chain_start_s(events, failed_s), expected_s, 1e-12);
    std::reverse(events.begin(), events.end());
    looks.near(chain_start_s(events, failed_s), expected_s, 1e-12);
  };
  const auto event = [](double from_s, double to_s, EventKind kind = EventKind::kFixLost) {
    return Event{kind, from_s, to_s, 1.0};
  };
  starts({}, 100.0, 90.0);
  starts({}, 4.0, 0.0);
  starts({event(70, 95)}, 100.0, 70.0);
  starts({event(70, 89)}, 100.0, 90.0);
  starts({event(70, 80.5), event(90, 92)}, 100.0, 70.0);
  starts({event(70, 79.5), event(90, 92)}, 100.0, 90.0);
  starts({event(20, 99)}, 100.0, 40.0);
  starts({event(70, 95), event(101, 120)}, 100.0, 70.0);
  starts({event(85, 95, EventKind::kStopped)}, 100.0, 90.0);
  starts({event(60, 99), event(95, 97), event(45, 52)}, 100.0, 45.0);

  const auto significant = holm({0.02, 0.001, 0.3, 0.011}, 0.05);
  // 0.001 < 0.05 / 4, 0.011 < 0.05 / 3, 0.02 < 0.05 / 2, 0.3 > 0.05.
  looks.right(significant == std::vector<bool>({true, true, false, true}));
  looks.right(holm({0.02, 0.001, 0.3, 0.017}, 0.05) == std::vector<bool>({false, true, false, false}));
  looks.right(holm({0.013, 0.013, 0.013, 0.013}, 0.05) == std::vector<bool>(4, false) && holm({}, 0.05).empty());

  ToleranceCurve curve;
  const auto point = [](double size, int success) {
    return TolerancePoint{.size = size, .success = success, .n = 20, .interval = wilson_interval(success, 20)};
  };
  curve.points = {point(1.0, 20), point(3.0, 12), point(10.0, 2)};
  looks.right(curve.monotone());
  curve.points = {point(10.0, 20), point(3.0, 12), point(1.0, 2)};
  looks.right(!curve.monotone());
  curve.points = {point(1.0, 18), point(3.0, 20), point(10.0, 2)};
  looks.right(curve.monotone());
  curve.points = {point(1.0, 20), point(3.0, 2), point(10.0, 3), point(30.0, 15)};
  looks.right(!curve.monotone());
  looks.right(usual_sizes("step_m") == std::vector<double>({1, 2, 3, 5, 10, 30}) &&
              usual_sizes("drift_m_s") == std::vector<double>({0.01, 0.03, 0.1, 0.3, 1}) &&
              usual_sizes("heading_deg") == std::vector<double>({0.1, 0.3, 1, 2, 5}) &&
              usual_sizes("height_m") == std::vector<double>({0.1, 0.3, 1, 3, 10}));
  return looks.figure();
}

/// A run's rows with one event of each kind, just so and just not so; two less than two seconds apart are one, with the
/// larger size.
StressFigure events_of_rows() {
  Looks looks;
  const GpsTime start = GpsTime::from_week_sow(1600, 100.0);
  RunEvents seen;
  const auto fix = [&](double t_s, const auto& change) {
    mission::GnssRow row;
    row.fix.t = start + t_s;
    row.fix.status = FixStatus::kSingle;
    row.fix.dop.gdop = 2.0;
    row.update.accepted = true, row.update.dimension = 3, row.update.nis = 16.2;
    change(row);
    looks.right(seen.gnss(row).ok());
  };
  const auto epoch = [&](double t_s, double off_m, mission::AutonomyState state) {
    mission::NavRow row;
    row.t = start + t_s;
    row.X_WB_true.p = {5.0, 0.0, 0.0}, row.estimate.X_WB.p = {5.0 + off_m, 0.0, 0.0};
    row.estimate.X_WB.R = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
    row.estimate.pose_covariance = 0.25 * Matrix6d::Identity();
    row.state = state;
    looks.right(seen.epoch(row).ok());
  };
  const auto nothing = [](mission::GnssRow&) {};
  fix(0.0, nothing);
  fix(1.0, [](auto& row) { row.fix.dop.gdop = 3.9; });  // by 1.9
  fix(2.0, [](auto& row) { row.fix.dop.gdop = 6.0; });  // by 2.1
  fix(3.0, nothing);                                    // by 4: of the same
  fix(20.0, [](auto& row) { row.fix.status = FixStatus::kNone, row.fix.dop.gdop = 50.0; });
  fix(21.0, nothing);  // after none: no jump
  // The 99.9 % point of three degrees is 16.266.
  fix(30.0, [](auto& row) { row.update.nis = 2.0 * 16.266236196238; });
  fix(31.5, [](auto& row) { row.update.nis = 3.0 * 16.266236196238; });
  fix(34.0, [](auto& row) { row.update.nis = 1.5 * 16.266236196238; });
  fix(40.0, [](auto& row) { row.update.nis = 99.0, row.update.accepted = false; });
  fix(50.0, [](auto& row) {
    row.truth.satellites.resize(4);
    for (int i = 0; i < 4; ++i) {
      auto& satellite = row.truth.satellites[static_cast<std::size_t>(i)];
      satellite.tracked = i != 0, satellite.line_of_sight = i == 1;
    }
  });
  // 14.156 is the 99.73 % point of three degrees: 0.5 m of sigma, 1.8813 m.
  epoch(60.0, 1.87, mission::AutonomyState::kDriving);
  epoch(62.5, 2.0 * 0.5 * std::sqrt(14.15625), mission::AutonomyState::kDriving);
  epoch(70.0, 0.0, mission::AutonomyState::kBlocked);
  epoch(71.0, 0.0, mission::AutonomyState::kBlind);
  epoch(80.0, 0.0, mission::AutonomyState::kObserving);
  struct Expected {
    EventKind kind;
    double from_s, to_s, size, within;
  };
  const std::vector<Expected> expected = {
      {EventKind::kDilutionJump, 2.0, 3.0, 4.0, 1e-12},  {EventKind::kFixLost, 20.0, 20.0, 1.0, 0.0},
      {EventKind::kUnlikelyFix, 30.0, 31.5, 3.0, 1e-7},  {EventKind::kUnlikelyFix, 34.0, 34.0, 1.5, 1e-7},
      {EventKind::kHiddenSignals, 50.0, 50.0, 2.0, 0.0}, {EventKind::kOverconfident, 62.5, 62.5, 2.0, 1e-4},
      {EventKind::kStopped, 70.0, 71.0, 1.0, 0.0}};
  const std::vector<Event> found = seen.events();
  looks.right(found.size() == expected.size());
  for (std::size_t k = 0; k < std::min(found.size(), expected.size()); ++k) {
    looks.right(found[k].kind == expected[k].kind);
    looks.near(found[k].from_s, expected[k].from_s, 1e-9), looks.near(found[k].to_s, expected[k].to_s, 1e-9);
    looks.near(found[k].size, expected[k].size, expected[k].within + 1e-12);
  }
  return looks.figure();
}

/// A value of players alone and of pairs: each has its own, and half of each pair's, after one pair of orders already;
/// of one in which three act together, the mean over the orders drawn, counted by hand.
StressFigure shares_of_players() {
  Looks looks;
  const std::vector<double> alone{1.0, -2.0, 0.5, 4.0, 0.0};
  const auto value_of = [&](Coalition c, double of_three) {
    const auto has = [c](std::size_t i) { return (c >> i & 1U) != 0; };
    double value = 7.0;
    for (std::size_t i = 0; i < alone.size(); ++i) value += has(i) ? alone[i] : 0.0;
    value += has(0) && has(3) ? 3.0 : 0.0;
    value += has(1) && has(4) ? -1.0 : 0.0;
    return value + (has(0) && has(1) && has(2) ? of_three : 0.0);
  };
  for (const std::size_t count : {2U, 7U, 20U}) {
    const auto orders = sampled_orders(5, count, 3);
    looks.right(orders.size() == (count == 7U ? 8 : count));
    for (std::size_t k = 0; k < orders.size(); k += 2)
      looks.right(std::equal(orders[k].begin(), orders[k].end(), orders[k + 1].rbegin()));
    const auto coalitions = coalitions_of(orders, 5);
    looks.right(coalitions.front() == 31U && coalitions.back() == 0U);
    for (const double of_three : {0.0, 6.0}) {
      std::vector<double> value;
      for (const Coalition c : coalitions) value.push_back(value_of(c, of_three));
      const ShapleyShares found = shapley_shares(orders, 5, coalitions, value);
      looks.near(found.total, 7.0 + 3.5 + 2.0 + of_three, 1e-13), looks.near(found.floor, 7.0, 1e-13);
      std::vector<double> expected{2.5, -2.5, 0.5, 5.5, -0.5};
      std::vector<std::vector<double>> of_pair(orders.size() / 2, std::vector<double>(3, 0.0));
      // The first of the three to leave takes it all.
      for (std::size_t k = 0; k < orders.size(); ++k)
        for (const std::size_t player : orders[k])
          if (player < 3) {
            of_pair[k / 2][player] += 0.5 * of_three;
            break;
          }
      const auto pairs = static_cast<double>(of_pair.size());
      for (std::size_t i = 0; i < 3; ++i) {
        double mean = 0.0, squares = 0.0;
        for (const auto& one : of_pair) mean += one[i] / pairs;
        for (const auto& one : of_pair) squares += (one[i] - mean) * (one[i] - mean);
        expected[i] += mean;
        if (of_pair.size() > 1)
          looks.near(found.order_sigma[i], std::sqrt(squares / (pairs * (pairs - 1.0))), 1e-12);
        else
          looks.right(std::isnan(found.order_sigma[i]));
      }
      for (std::size_t i = 0; i < 5; ++i) looks.near(found.share[i], expected[i], 1e-12);
    }
  }
  return looks.figure();
}

/// Orders of errors a h^p at steps of any ratio, what is left after them, series that fall by a share; a front of
/// models laid out by hand, and times of a fixed part and one by work.
StressFigure orders_and_fronts() {
  Looks looks;
  for (const double p : {0.5, 1.0, 2.0, 4.0, -1.0})
    for (const auto& [h1, h2, h3] :
         {std::array{0.4, 0.2, 0.1}, std::array{0.5, 0.3, 0.25}, std::array{1.0, 0.1, 0.07}}) {
      const auto f = [&](double h) { return 3.0 - 0.7 * std::pow(h, p); };
      const double e12 = std::abs(f(h1) - f(h2)), e23 = std::abs(f(h2) - f(h3));
      // Differences of 3 round by an epsilon each; steps near one another take a digit.
      looks.near(observed_order(h1, h2, h3, e12, e23, 1e-12), p, 1e-9);
      if (p > 0.0) looks.near(richardson_error(h1, h2, e12, p), 0.7 * std::pow(h2, p), 1e-11);
    }
  looks.near(observed_order(0.4, 0.2, 0.1, 1.0, 1.0, 0.0), 0.0, 1e-9);
  looks.right(std::isnan(observed_order(0.4, 0.2, 0.1, 1e-13, 1e-14, 1e-12)) &&
              std::isnan(observed_order(0.4, 0.2, 0.1, 1.0, 1e-13, 1e-12)) && std::isnan(richardson_error(2, 1, 1, 0)));
  // 0.3 of the last each: 0.3 + 0.09 + ... of it are left, 3 / 7.
  looks.near(extrapolated_error(2.0, 0.6), 0.6 * 3.0 / 7.0, 1e-14);
  looks.right(std::isnan(extrapolated_error(1.0, 1.0)) && std::isnan(extrapolated_error(1.0, 2.0)));

  const auto model = [](const char* name, double error, double cpu_s, double undefined, std::int64_t work) {
    MeasuredModel m;
    m.name = name, m.error = error, m.cpu_s = cpu_s, m.undefined_share = undefined, m.work = work;
    m.cpu_low_s = 0.9 * cpu_s, m.cpu_high_s = 1.1 * cpu_s, m.simulated_s = 10.0;
    return m;
  };
  std::vector<MeasuredModel> models = {model("quick", 5.0, 1.0, 0.0, 100), model("slow", 1.0, 4.0, 0.0, 475),
                                       model("worse", 5.5, 1.05, 0.0, 1),  model("between", 2.0, 2.0, 0.0, 225),
                                       model("partial", 0.5, 0.5, 0.3, 1), model("as good", 2.0, 2.0, 0.0, 225),
                                       model("none", kNaN, 0.1, 0.0, 1)};
  mark_front(models);
  const std::vector<bool> front{true, true, false, true, true, true, false};
  for (std::size_t k = 0; k < models.size(); ++k) looks.right(models[k].on_front == front[k]);
  looks.right(models[0].tied_with == std::vector<std::string>{"worse"} && models[1].tied_with.empty() &&
              models[3].tied_with == std::vector<std::string>{"as good"} && models[6].tied_with.empty());
  // 10 s of each: 2 s and 0.08 s of work: 10, 40 and 20 s.
  const TimeFit fit = fit_time({models[0], models[1], models[3]});
  looks.near(fit.fixed_s, 2.0, 1e-9), looks.near(fit.per_work_s, 0.08, 1e-11), looks.near(fit.worst_ratio, 1.0, 1e-9);
  looks.right(std::isnan(fit_time({models[0], models[1]}).fixed_s) &&
              std::isnan(fit_time({models[3], models[3], models[5]}).fixed_s));
  return looks.figure();
}

}  // namespace

std::vector<StressCase> cause_cases() {
  StressRows rows;
  rows.of({.group = StressGroup::kData,
           .mechanism = "verdicts of a study on what was laid out by hand",
           .why = "a gap of the other end, a step of Holm's too many, a share for its complement, an order's sign",
           .expected = "counts and closed forms, each just so and just not so: roundings",
           .unit = "of the bound",
           .loose = "roundings of the least of many figures"});
  rows.add("verdicts/chains_and_steps", chains_and_steps)
      .add("verdicts/events_of_rows", events_of_rows)
      .add("verdicts/shares_of_players", shares_of_players)
      .add("verdicts/orders_and_fronts", orders_and_fronts);
  return rows.take();
}

}  // namespace canyon::study
