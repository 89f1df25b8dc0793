// Silent failures and honest covariance of the own methods, by simulated trials. What the figures mean stands in
// docs/registration.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/core/units.h"
#include "canyon/lidar/registration/prepared_cloud.h"
#include "canyon/tests/lidar/registration/trials/tally.h"
#include "canyon/tests/support/setting.h"

namespace canyon::lidar::trials {
namespace {

using canyon::testing::setting;

/// One line per trial, where CANYON_TRIALS_CSV names a file.
class Lines {
 public:
  Lines() : file_(std::fopen(setting("CANYON_TRIALS_CSV", "/dev/null").c_str(), "w")) {
    if (file_)
      std::fprintf(
          file_,
          "place,sensor,ring,trial,status,error_m,error_deg,inside,open,nees,closed,widest_3_sigma_m,"
          "overlap,points,ambiguous,pcl_right,error_roll,error_pitch,"
          "error_yaw,error_x,error_y,error_z,sigma_roll,sigma_pitch,sigma_yaw,sigma_x,sigma_y,sigma_z,all_right\n");
  }
  ~Lines() {
    if (file_) std::fclose(file_);
  }
  void add(const std::string& cell, std::span<const Outcome> outcomes) {
    for (std::size_t k = 0; file_ && k < outcomes.size(); ++k) {
      const Outcome& o = outcomes[k];
      const Verdict& v = o.verdict;
      std::fprintf(file_, "%s,%zu,%s,%.4f,%.4f,%d,%d,%.3f,%d,%.4f,%.3f,%zu,%d,%d", cell.c_str(), k,
                   row_of(registration_statuses(), o.status).name, v.error_m, v.error_deg, v.inside, v.undecided,
                   v.nees, v.closed, v.widest_3_sigma_m, o.overlap, o.points, o.ambiguous, o.pcl_right);
      for (const Vector6d& column : {v.error, v.sigma}) {
        for (const double x : column) std::fprintf(file_, ",%.5f", x);
      }
      std::fprintf(file_, ",%d\n", o.all_right);
    }
  }

 private:
  std::FILE* file_;
};

/// CANYON_TRIALS_SEED draws other trials than those that anything was looked at with.
std::uint64_t seed_or(const char* otherwise) {
  return std::stoull(setting("CANYON_TRIALS_SEED", otherwise));
}

/// All cells, or those that CANYON_TRIALS_PLACE and CANYON_TRIALS_SENSOR name.
template <class Take>
void every_cell(const Take& take) {
  const std::string place_only = setting("CANYON_TRIALS_PLACE", ""), sensor_only = setting("CANYON_TRIALS_SENSOR", "");
  for (const Place& place : places()) {
    if (!place_only.empty() && place_only.find(place.name) == std::string::npos) continue;
    for (const Sensor& sensor : sensors()) {
      if (!sensor_only.empty() && sensor_only.find(sensor.name) == std::string::npos) continue;
      take(place, sensor);
    }
  }
}

TEST(TrialsNightly, SilentFailures) {
  const auto count = std::stoul(setting("CANYON_TRIALS_PER_CELL", "21"));
  Asked asked;
  asked.method = setting("CANYON_TRIALS_METHOD", "gicp");
  asked.pcl = setting("CANYON_TRIALS_PCL", "1") == "1";
  Lines lines;
  std::printf("%s, %zu trials per place, sensor and ring\n%s", asked.method.c_str(), count, table_head().c_str());
  Tally all;
  std::vector<Tally> by_ring(rings().size());
  std::map<std::string, Tally> by_place;
  every_cell([&](const Place& place, const Sensor& sensor) {
    for (std::size_t r = 0; r < rings().size(); ++r) {
      const Ring& ring = rings()[r];
      const auto outcomes = run_trials(asked, place, sensor, ring, seed_or("1"), count);
      lines.add(std::string(place.name) + ',' + sensor.name + ',' + ring.name, outcomes);
      Tally cell;
      for (const Outcome& o : outcomes) cell.add(o);
      const std::string name = std::string(place.name) + ' ' + sensor.name + ' ' + ring.name;
      std::printf("%s", table_row(name, cell).c_str());
      std::fflush(stdout);
      EXPECT_LE(cell.silent, binomial_most(cell.converged, 0.02, kAlarm)) << name;  // the requirement: 2 %
      by_ring[r].add(cell);
      by_place[place.name].add(cell);
      all.add(cell);
    }
  });
  for (std::size_t r = 0; r < rings().size(); ++r) {
    std::printf("%s", table_row(rings()[r].name, by_ring[r]).c_str());
    if (asked.pcl) {
      EXPECT_GE(by_ring[r].converged, by_ring[r].pcl_right) << rings()[r].name;
    }
  }
  for (const auto& [name, tally] : by_place) {
    std::printf("%s", table_row(name, tally).c_str());
    EXPECT_GE(tally.recalled, binomial_fewest(tally.ambiguous, 0.9, kAlarm)) << name;  // the requirement
  }
  std::printf("%s", table_row("all", all).c_str());
  // The requirements, with room for chance.
  EXPECT_LE(all.silent, binomial_most(all.converged, 0.005, kAlarm));
  EXPECT_LE(by_ring[0].refused_good, binomial_most(by_ring[0].right, 0.05, kAlarm));
  EXPECT_EQ(all.wide, 0);
}

/// Cells in which the NEES that is asked for is missed, and why is known: a post or two tell of a field, and a bound
/// that holds for so few witnesses is wide in the mean (docs/registration.md). Mean and standard deviation of NEES per
/// closed direction, of so many converged trials with seed 2027, 2026-11-29.
struct KnownMiss {
  const char *place, *sensor;
  double nees, sigma;
  int trials;
};
constexpr KnownMiss kKnownMisses[] = {{"field", "vlp16", 0.193, 0.249, 198},
                                      {"field", "hdl32e", 0.263, 0.392, 198},
                                      {"field", "os1_128", 0.486, 0.857, 200}};

const KnownMiss* known_miss(const std::string& method, const Place& place, const Sensor& sensor) {
  for (const KnownMiss& miss : kKnownMisses)
    if (method == "gicp" && miss.place == std::string(place.name) && miss.sensor == std::string(sensor.name))
      return &miss;
  return nullptr;
}

/// That a known miss is what it was, either way: k sigma / sqrt(n) of both samples, k = 4, false alarm 6e-5.
void expect_as_known(const KnownMiss& miss, const Tally& tally, const std::string& name) {
  const double spread = 4.0 * miss.sigma * std::sqrt(1.0 / miss.trials + 1.0 / std::max(tally.judged, 1));
  EXPECT_NEAR(tally.nees_mean(), miss.nees, spread)
      << name << ": kKnownMisses and docs/registration.md want new figures";
}

// Coverage: 88 to 99 % are asked for. Of 200 trials all may be covered by chance (0.99^200 is 13 %), so the upper end
// is judged over all cells but the known misses together; cell by cell from 917 trials on (0.99^917 is the alarm).
TEST(TrialsNightly, CovarianceOfPlacesThatNothingIsCalibratedOn) {
  const auto count = std::stoul(setting("CANYON_TRIALS_PER_CELL", "200"));
  const bool calibrating = setting("CANYON_TRIALS_CALIBRATING", "0") == "1";
  Asked asked;
  asked.method = setting("CANYON_TRIALS_METHOD", "gicp");
  asked.forms = {"calibrated"};
  if (setting("CANYON_TRIALS_FORMS", "1") == "1")
    asked.forms.insert(asked.forms.end(), {"sandwich", "hessian", "censi", "sampled", "guess_and_bias"});
  Lines lines;
  Tally elsewhere;
  every_cell([&](const Place& place, const Sensor& sensor) {
    if (place.judged == calibrating) return;
    const auto outcomes = run_trials(asked, place, sensor, rings()[0], seed_or("2"), count);
    lines.add(std::string(place.name) + ',' + sensor.name + ',' + rings()[0].name, outcomes);
    const std::string name = std::string(place.name) + ' ' + sensor.name;
    const KnownMiss* const miss = known_miss(asked.method, place, sensor);
    for (std::size_t f = 0; f < asked.forms.size(); ++f) {
      const Tally tally = of_form(outcomes, f);
      std::printf("%-12s %-8s %-15s converged %4d  NEES %9.3f  95 %% covers %5.1f %%%s\n", place.name, sensor.name,
                  asked.forms[f].c_str(), tally.judged, tally.nees_mean(), 100 * tally.coverage(),
                  f == 0 && miss != nullptr ? "  (known miss)" : "");
      std::fflush(stdout);
      if (f > 0 || calibrating) continue;  // the requirement is of the default form
      EXPECT_GE(tally.within_95, binomial_fewest(tally.judged, 0.88, kAlarm)) << name;
      if (miss != nullptr) {
        expect_as_known(*miss, tally, name);
        continue;
      }
      EXPECT_GT(tally.nees_mean(), 0.5) << name;
      EXPECT_LT(tally.nees_mean(), 2.0) << name;
      EXPECT_LE(tally.within_95, binomial_most(tally.judged, 0.99, kAlarm)) << name;
      elsewhere.add(tally);
    }
  });
  std::printf("all but known misses: 95 %% covers %d of %d\n", elsewhere.within_95, elsewhere.judged);
  EXPECT_LE(elsewhere.within_95, binomial_most(elsewhere.judged, 0.99, kAlarm));
}

/// What pairs of a table came to: within 0.05 m and 0.2 degrees in what the result calls closed, and in all six
/// directions whatever it calls them; right to 0.2 m and 0.5 degrees; silent; with a direction called open.
struct Pairs {
  int all = 0, within = 0, within_six = 0, right = 0, silent = 0, open = 0;

  void add(const Verdict& v) {
    const auto near = [](double m, double deg) { return m < 0.05 && deg < 0.2 ? 1 : 0; };
    ++all;
    within += near(v.error_m, v.error_deg);
    within_six += near(v.error.tail<3>().norm(), v.error.head<3>().norm() / kDegree);
    right += v.right ? 1 : 0;
    silent += v.silent() ? 1 : 0;
    open += v.closed < 6 ? 1 : 0;
  }
  void add(const Pairs& o) {
    all += o.all, within += o.within, within_six += o.within_six;
    right += o.right, silent += o.silent, open += o.open;
  }
  void print(const std::string& name) const {
    std::printf(
        "%-21s %4d: within 0.05 m and 0.2 deg %4d (in all six directions %4d), right to 0.2 m and 0.5 deg %4d, "
        "silently wrong %d, a direction called open %4d (%.1f %%)\n",
        name.c_str(), all, within, within_six, right, silent, open, 100.0 * open / all);
    std::fflush(stdout);
  }
};

// Of places that leave no direction open: 5 cm and 0.2 degrees in 99 % of the pairs. What few beams see of a street may
// leave a direction open that its surfaces do not; then that is said, and the prior stands there. With 16 beams the
// 99 % are missed, and how far is known (docs/registration.md): 780 of 800 (96.2 to 98.4 %) were within in what was
// called closed, and 25 of 84 (21 to 40 %) had a direction called open, with guesses twice as far off. The ends of
// these intervals are held.
TEST(TrialsNightly, PairsOfEveryBeamTable) {
  const auto count = std::stoul(setting("CANYON_TRIALS_PER_CELL", "100"));
  struct Beams {
    Sensor sensor;
    bool few;
  };
  constexpr Beams kAll[] = {{{"vlp16", 1800}, true},   {{"grid16", 1800}, true},  {{"hdl32e", 1800}, false},
                            {{"hdl64e", 1800}, false}, {{"os1_64", 1024}, false}, {{"os1_128", 1024}, false},
                            {{"mid360", 0}, false}};
  const Ring near{"0-0.5 m 0-2 deg", 0.0, 0.5, 0.0, 2.0};
  Asked asked;
  asked.leaf_m = std::stod(setting("CANYON_TRIALS_LEAF", "0.5"));
  const std::string sensor_only = setting("CANYON_TRIALS_SENSOR", "");
  Pairs many_beams, few_beams;
  for (const auto& [sensor, few] : kAll) {
    if (!sensor_only.empty() && sensor_only.find(sensor.name) == std::string::npos) continue;
    Pairs table;
    for (const Place& place : places()) {
      if (place.open_x || place.open_turn || place.period_m > 0.0) continue;
      Pairs here;
      for (const Outcome& o : run_trials(asked, place, sensor, near, seed_or("5"), count)) here.add(o.verdict);
      here.print(std::string(sensor.name) + ' ' + place.name);
      table.add(here);
    }
    table.print(sensor.name);
    EXPECT_GE(table.right, binomial_fewest(table.all, 0.99, kAlarm)) << sensor.name;
    EXPECT_LE(table.silent, binomial_most(table.all, 0.005, kAlarm)) << sensor.name;
    if (few) {
      EXPECT_GE(table.within, binomial_fewest(table.all, 0.962, kAlarm)) << sensor.name;
      EXPECT_LE(table.open, binomial_most(table.all, 0.40, kAlarm)) << sensor.name;
    } else {
      EXPECT_GE(table.within_six, binomial_fewest(table.all, 0.99, kAlarm)) << sensor.name;
      EXPECT_LE(table.open, binomial_most(table.all, 0.01, kAlarm)) << sensor.name;
    }
    (few ? few_beams : many_beams).add(table);
  }
  many_beams.print("more than 16 beams");
  few_beams.print("16 beams");
  // All tables together, with no room for chance: by the 1994 of 2000 that were within, fewer than 99 % of as many come
  // up once in a million; of 2800 none was off by more than 0.2 m or 0.5 degrees.
  EXPECT_GE(many_beams.within, 0.99 * many_beams.all);
  EXPECT_GE(many_beams.right + few_beams.right, 0.99 * (many_beams.all + few_beams.all));
}

TEST(TrialsNightly, ASubsetFailsSilentlyNoMoreOftenThanPromised) {
  Tally all, near;
  for (const Place& place : places()) {
    for (std::size_t r = 0; r < 3; ++r) {
      for (const Outcome& o : run_trials({}, place, sensors()[0], rings()[r], 3, 2)) {
        all.add(o);
        if (r == 0) near.add(o);
      }
    }
  }
  std::printf("%s%s", table_head().c_str(), table_row("subset", all).c_str());
  EXPECT_LE(all.silent, binomial_most(all.converged, 0.005, kAlarm));
  EXPECT_LE(near.refused_good, binomial_most(near.right, 0.05, kAlarm));
  EXPECT_GE(all.recalled, binomial_fewest(all.ambiguous, 0.9, kAlarm));
}

/// Between facades that repeat: each of these converged 5 to 6 m off, a period, while places were weighed as they were
/// held at the prior and nobody looked along the street for others.
TEST(Trials, APeriodOffIsNoAnswer) {
  struct Case {
    std::size_t sensor, ring;
    std::uint64_t number;
  };
  const auto facades = std::find_if(places().begin(), places().end(), [](const Place& p) { return p.period_m > 0; });
  ASSERT_NE(facades, places().end());
  const auto method = *make_registration({});
  for (const Case& c :
       {Case{0, 1, 56}, Case{0, 2, 27}, Case{0, 2, 127}, Case{0, 2, 135}, Case{1, 2, 19}, Case{2, 1, 11}}) {
    const Trial trial = make_trial(*facades, sensors()[c.sensor], rings()[c.ring], 2027, c.number);
    const auto source = method->prepare(trial.source);
    const Registration::Placed target{method->prepare(trial.target), Pose{}};
    const auto result = method->align_with_prior(*source, {&target, 1}, trial.prior);
    const Verdict verdict = judge(trial, result, rms_radius(source->points));
    EXPECT_FALSE(verdict.silent()) << sensors()[c.sensor].name << ' ' << rings()[c.ring].name << ' ' << c.number << ": "
                                   << verdict.error_m << " m off";
  }
  // Who is near enough is not refused for it.
  int converged = 0;
  for (const Outcome& o : run_trials({}, *facades, sensors()[1], rings()[0], 2027, 5)) {
    converged += o.verdict.converged ? 1 : 0;
    EXPECT_TRUE(o.verdict.right);
  }
  EXPECT_EQ(converged, 5);
}

/// Where nothing is open but by its width, and what leans by the prior's width would take all else with it, the
/// surfaces knew more than the prior: both were degenerate, with the guess for a pose, half a metre off.
TEST(Trials, WhatTheSurfacesKnowBetterThanThePriorIsKept) {
  const auto facades = std::find_if(places().begin(), places().end(), [](const Place& p) { return p.period_m > 0; });
  ASSERT_NE(facades, places().end());
  const auto method = *make_registration({});
  for (const std::uint64_t number : {119U, 193U}) {
    const Trial trial = make_trial(*facades, sensors()[0], rings()[0], 2027, number);
    const auto source = method->prepare(trial.source);
    const Registration::Placed target{method->prepare(trial.target), Pose{}};
    const auto result = method->align_with_prior(*source, {&target, 1}, trial.prior);
    EXPECT_EQ(result.status, RegistrationStatus::kNotConverged) << number;
    EXPECT_TRUE(result.covariance.allFinite()) << number;
    EXPECT_LT(judge(trial, result, rms_radius(source->points)).error_m, 0.05) << number;
  }
}

TEST(Trials, SameOutcomesForAnyNumberOfThreads) {
  std::vector<Outcome> first;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    const auto outcomes = run_trials({}, places()[1], sensors()[0], rings()[1], 4, 3);
    if (first.empty()) first = outcomes;
    for (std::size_t k = 0; k < first.size(); ++k) {
      EXPECT_EQ(outcomes[k].verdict.error_m, first[k].verdict.error_m);
      EXPECT_EQ(outcomes[k].verdict.nees, first[k].verdict.nees);
      EXPECT_EQ(outcomes[k].status, first[k].status);
    }
  }
  set_threads(0);
}

}  // namespace
}  // namespace canyon::lidar::trials
