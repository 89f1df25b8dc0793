// The measuring itself on probes whose answers are known.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/study/tradeoff/measuring/differences.h"
#include "canyon/study/tradeoff/measuring/front.h"
#include "canyon/study/tradeoff/measuring/measure.h"
#include "canyon/study/tradeoff/measuring/observed_order.h"

namespace canyon::study {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Values that err as `error`, at a cost that is said and not measured.
class SaidProbe final : public Probe {
 public:
  SaidProbe(double error, double cpu_s, std::int64_t work = 1) : error_(error), cpu_s_(cpu_s), work_(work) {}
  Result<ProbeRun> run() override {
    ProbeRun run;
    run.samples.values = {{error_}, {-error_}, {error_}};
    run.cpu_s = cpu_s_;
    run.work = work_;
    return run;
  }

 private:
  double error_, cpu_s_;
  std::int64_t work_;
};

/// A ladder of steps 8, 4, 2, 1 whose error is step^order.
MeasuredLadder measured(double order, std::optional<double> theory) {
  Contenders c;
  for (const double h : {8.0, 4.0, 2.0, 1.0}) {
    c.names.push_back(std::to_string(static_cast<int>(h)));
    c.values.push_back(h);
    c.probes.push_back(std::make_unique<SaidProbe>(std::pow(h, order), 1.0 / h, static_cast<std::int64_t>(8.0 / h)));
  }
  MeasuredLadder ladder;
  ladder.order_must_hold = true;
  ladder.order_theory = theory;
  EXPECT_TRUE(measure(c, 5, 1, ladder));
  return ladder;
}

TEST(ObservedOrder, IsReadOffDifferencesAlone) {
  // f = 7 + 3 h^p: the differences of three steps tell p whatever the limit is, to rounding of the logarithms.
  for (const double p : {1.0, 2.0, 4.0, 0.5})
    for (const auto& [h1, h2, h3] : {std::array{0.4, 0.2, 0.1}, std::array{0.5, 0.2, 0.1}, std::array{1.0, 0.4, 0.3}}) {
      const auto f = [&](double h) { return 7.0 + 3.0 * std::pow(h, p); };
      EXPECT_NEAR(observed_order(h1, h2, h3, f(h1) - f(h2), f(h2) - f(h3), 0.0), p, 1e-9) << p << " " << h1;
    }
  EXPECT_TRUE(std::isnan(observed_order(0.4, 0.2, 0.1, 1e-9, 1e-12, 1e-10)));  // rounding
}

TEST(ObservedOrder, WhatIsLeftOfTheFinestRung) {
  const auto f = [](double h) { return 3.0 * h * h; };
  EXPECT_NEAR(richardson_error(0.2, 0.1, f(0.2) - f(0.1), 2.0), f(0.1), 1e-15);
  EXPECT_NEAR(extrapolated_error(4.0, 1.0), 1.0 / 3.0, 1e-15);  // 1/4 + 1/16 + ...
  EXPECT_TRUE(std::isnan(extrapolated_error(1.0, 2.0)));        // does not fall
}

TEST(Measuring, AnOrderThatARowDoesNotKeepIsFlagged) {
  const MeasuredLadder kept = measured(2.0, 2.0), broken = measured(1.0, 2.0);
  EXPECT_NEAR(kept.order_observed, 2.0, 1e-9);
  EXPECT_TRUE(kept.order_holds());
  EXPECT_NEAR(broken.order_observed, 1.0, 1e-9);
  EXPECT_FALSE(broken.order_holds());
  EXPECT_TRUE(measured(1.0, std::nullopt).order_holds());
}

// 2026-11-22: an integrator that gets worse at its finest step kept the order of its coarse ones.
TEST(Measuring, AnOrderThatIsLostAtFineRungsIsFlagged) {
  EXPECT_LT(observed_order(0.4, 0.2, 0.1, 1.0, 2.0, 0.0), -0.9);  // doubling as the step halves: order -1
  EXPECT_NEAR(observed_order(0.4, 0.2, 0.1, 1.0, 2.0, 0.0), -1.0, 1e-9);
  EXPECT_NEAR(observed_order(0.4, 0.2, 0.1, 1.0, 1.0, 0.0), 0.0, 1e-9);
  Contenders c;
  for (const auto& [h, error] : {std::pair(8.0, 64.0), {4.0, 16.0}, {2.0, 4.0}, {1.0, 24.0}}) {
    c.names.push_back(std::to_string(static_cast<int>(h)));
    c.values.push_back(h);
    c.probes.push_back(std::make_unique<SaidProbe>(error, 1.0));
  }
  MeasuredLadder ladder;
  ladder.order_must_hold = true;
  ladder.order_theory = 2.0;
  ASSERT_TRUE(measure(c, 5, 1, ladder));
  EXPECT_LT(ladder.order_observed, 0.0);
  EXPECT_FALSE(ladder.order_holds());
}

// 2026-11-22: a solver that refuses the hard epochs looked better than one that takes all of them.
TEST(Measuring, RungsAreComparedOverWhatAllOfThemHave) {
  class Refusing final : public Probe {
   public:
    explicit Refusing(bool refuses) : refuses_(refuses) {}
    Result<ProbeRun> run() override {
      ProbeRun run;
      run.samples.values = {{3.0}, {refuses_ ? kNaN : 40.0}, {refuses_ ? 4.0 : 3.0}};
      run.cpu_s = refuses_ ? 0.5 : 1.0;
      run.work = 1;
      return run;
    }
    bool refuses_;
  };
  Contenders c;
  for (const bool refuses : {true, false}) {
    c.names.push_back(refuses ? "picky" : "all");
    c.values.push_back(std::nullopt);
    c.probes.push_back(std::make_unique<Refusing>(refuses));
  }
  MeasuredLadder ladder;
  ASSERT_TRUE(measure(c, 5, 1, ladder));
  EXPECT_LT(ladder.models[0].error, ladder.models[1].error);
  EXPECT_DOUBLE_EQ(ladder.models[0].common_error, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(ladder.models[1].common_error, 3.0);
  EXPECT_NEAR(ladder.models[0].undefined_share, 1.0 / 3.0, 1e-15);
  EXPECT_TRUE(ladder.models[1].on_front);
}

TEST(Measuring, DifferencesToARungAndWhatItErrsItself) {
  Contenders c;
  for (const double h : {4.0, 2.0, 1.0}) {
    c.names.push_back(std::to_string(static_cast<int>(h)));
    c.values.push_back(h);
    c.probes.push_back(std::make_unique<SaidProbe>(h * h, 1.0));
  }
  c.reference = 2;
  MeasuredLadder ladder;
  ASSERT_TRUE(measure(c, 5, 1, ladder));
  EXPECT_DOUBLE_EQ(ladder.models[0].error, 15.0);
  EXPECT_DOUBLE_EQ(ladder.models[1].error, 3.0);
  EXPECT_DOUBLE_EQ(ladder.models[2].error, 0.0);
  EXPECT_TRUE(ladder.models[2].is_reference);
  EXPECT_NEAR(ladder.reference_error, 1.0, 1e-12);  // 3 / (2^2 - 1): what h = 1 really errs
}

TEST(Measuring, WhatOnlyOneOfTwoHasIsNoDifferenceButCounted) {
  Samples a, b;
  a.values = {{1.0, kNaN, 5.0}};
  b.values = {{2.0, 3.0}};  // shorter: the rest is undefined
  const Differences d = differences(a, &b);
  EXPECT_DOUBLE_EQ(rms(d), 1.0);
  EXPECT_DOUBLE_EQ(d.undefined_share, 2.0 / 3.0);
  Samples v;
  v.dimension = 2;
  v.values = {{3.0, 4.0, kNaN, 1.0}};
  EXPECT_DOUBLE_EQ(rms(differences(v, nullptr)), 5.0);  // one vector of length 5
}

TEST(Measuring, WhatIsOfDifferentThingsIsNoDifferenceButCounted) {
  Samples a, b;
  a.values = {{1.0, 40.0, 3.0}};
  a.of = {{7, 7, 9}};
  b.values = {{2.0, 10.0, 3.0}};
  b.of = {{7, 8, 9}};  // the second meets another surface
  const Differences d = differences(a, &b);
  EXPECT_DOUBLE_EQ(rms(d), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(d.undefined_share, 1.0 / 3.0);
}

MeasuredModel model(const char* name, double error, double low_s, double cpu_s, double high_s) {
  MeasuredModel m;
  m.name = name;
  m.error = error;
  m.cpu_s = cpu_s;
  m.cpu_low_s = low_s;
  m.cpu_high_s = high_s;
  m.simulated_s = 1.0;
  return m;
}

TEST(Front, HoldsWhatNothingBeats) {
  std::vector<MeasuredModel> models{model("quick", 9.0, 0.9, 1.0, 1.1), model("middle", 3.0, 1.8, 2.0, 2.2),
                                    model("worse", 4.0, 2.1, 2.3, 2.5), model("exact", 1.0, 7.0, 8.0, 9.0),
                                    model("undefined", kNaN, 0.1, 0.1, 0.1)};
  mark_front(models);
  EXPECT_TRUE(models[0].on_front && models[1].on_front && models[3].on_front);
  EXPECT_FALSE(models[2].on_front || models[4].on_front);
  EXPECT_THAT(models[0].tied_with, IsEmpty());
  EXPECT_THAT(models[1].tied_with, ElementsAre("worse"));
  EXPECT_THAT(models[2].tied_with, ElementsAre("middle"));
}

// 2026-11-22: what is undefined for a third of the epochs dominated what has them all.
TEST(Front, WhatIsUndefinedMoreOftenDominatesNothing) {
  std::vector<MeasuredModel> models{model("picky", 1.0, 0.9, 1.0, 1.1), model("all", 2.0, 1.9, 2.0, 2.1)};
  models[0].undefined_share = 0.3;
  mark_front(models);
  EXPECT_TRUE(models[0].on_front && models[1].on_front);
}

// Who changes places on the front when times are drawn anew was tied: each time's own interval holds both draws.
TEST(Front, WhatChangesBetweenTwoMeasurementsWasTied) {
  std::vector<MeasuredModel> first{model("a", 2.0, 0.9, 1.0, 1.2), model("b", 1.0, 0.95, 1.1, 1.3)};
  std::vector<MeasuredModel> second = first;
  second[1].cpu_s = 0.98;
  mark_front(first);
  mark_front(second);
  EXPECT_TRUE(first[0].on_front);
  EXPECT_FALSE(second[0].on_front);
  EXPECT_THAT(first[0].tied_with, ElementsAre("b"));
}

TEST(Front, TimeIsFittedToWork) {
  std::vector<MeasuredModel> models;
  for (const int work : {10, 100, 1000}) {
    const double t = 0.5 + 0.01 * work;
    models.push_back(model("m", 1.0, t, t, t));
    models.back().work = work;
  }
  const TimeFit fit = fit_time(models);
  EXPECT_NEAR(fit.fixed_s, 0.5, 1e-12);
  EXPECT_NEAR(fit.per_work_s, 0.01, 1e-14);
  EXPECT_NEAR(fit.worst_ratio, 1.0, 1e-10);
}

TEST(Repetitions, RunInAnOrderOfTheirOwnEachTime) {
  const auto first = shuffled(6, 1, 0), second = shuffled(6, 1, 1);
  EXPECT_NE(first, second);
  EXPECT_EQ(first, shuffled(6, 1, 0));
  auto sorted = first;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_THAT(sorted, ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Repetitions, AProbeThatDoesOtherWorkEachTimeIsACauseToStop) {
  class Restless final : public Probe {
   public:
    Result<ProbeRun> run() override {
      ProbeRun run;
      run.samples.values = {{1.0}};
      run.work = ++work_;
      run.cpu_s = 1.0;
      return run;
    }
    std::int64_t work_ = 0;
  };
  std::vector<std::unique_ptr<Probe>> probes;
  probes.push_back(std::make_unique<Restless>());
  EXPECT_THROW(static_cast<void>(repeat(probes, 5, 1)), ProgramError);
}

}  // namespace
}  // namespace canyon::study
