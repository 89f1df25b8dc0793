// Orders that the rows of the integrators claim, observed on smooth motion without noise; and a row that lies.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/mission/config/mission_file.h"
#include "canyon/study/tradeoff/measuring/measure.h"
#include "canyon/study/tradeoff/probes/strapdown.h"

namespace canyon::study {
namespace {

constexpr SmoothFigure kFigures[] = {SmoothFigure::kPosition, SmoothFigure::kVelocity, SmoothFigure::kAttitude};
constexpr const char* kNames[] = {"position", "velocity", "attitude"};
constexpr double kRounding[] = {1e-8, 1e-9, 1e-13};  // of the probes' table: coordinates of 6e6 m

MeasuredLadder measured(const fusion::StrapdownRow& row, std::size_t figure) {
  Contenders c;
  for (const int rate_hz : {50, 100, 200, 400}) {
    c.names.push_back(std::to_string(rate_hz));
    c.values.push_back(rate_hz);
    c.probes.push_back(make_smooth_probe(row, rate_hz, kFigures[figure]));
  }
  c.rounding = kRounding[figure];
  MeasuredLadder ladder;
  ladder.order_must_hold = true;
  ladder.order_theory = claimed_order(row, kFigures[figure]);
  EXPECT_TRUE(measure(c, 5, 1, ladder));
  return ladder;
}

TEST(IntegratorOrder, IsWhatEveryRowClaims) {
  for (const fusion::StrapdownRow& row : fusion::strapdown_models())
    for (std::size_t i = 0; i < 3; ++i) {
      const MeasuredLadder ladder = measured(row, i);
      std::printf("%-13s %s: order %.3f, theory %.0f, error at 400 Hz %.2e\n", row.name, kNames[i],
                  ladder.order_observed, *ladder.order_theory, ladder.models.back().error);
      // 0.2: the next term of the error is of one order more, and at most 0.15 of the first at 50 to 200 Hz.
      EXPECT_TRUE(ladder.order_holds()) << row.name << " " << kNames[i] << ": " << ladder.order_observed;
    }
}

/// three_sample in name, the crudest of all in deed.
std::unique_ptr<fusion::Strapdown> make_broken(GravityFunction gravity) {
  return fusion::make_strapdown("euler", gravity);
}

TEST(IntegratorOrder, AnIntegratorThatIsBrokenOnPurposeIsFlagged) {
  const fusion::StrapdownRow row{"broken", {make_broken, 4, 4}, "says 4", nullptr, 4};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(measured(row, i).order_holds()) << kNames[i];
}

TEST(IntegratorOrder, OfProofMassesIsWhatEveryRowClaims) {
  const auto file = mission::MissionFile::load("");
  const mission::PreparedMission nowhere;
  const Tape still;
  for (const Ladder& ladder : built_in_ladders().ladder) {
    if (ladder.for_each != "mems.integrator") continue;
    const auto lists = make_rungs(ladder, *file, "high", probe_keys());
    ASSERT_TRUE(lists) << lists.error().str();
    EXPECT_EQ(lists->size(), 4u);
    for (const RungList& list : *lists) {
      const auto measured = measure(list, {nowhere, still, 1, 5, 1});
      ASSERT_TRUE(measured) << measured.error().str();
      std::printf("%s: order %.3f, theory %.0f\n", list.of.c_str(), measured->order_observed,
                  measured->order_theory.value_or(kNaN));
      EXPECT_TRUE(measured->order_holds()) << list.of << ": " << measured->order_observed;
    }
  }
}

}  // namespace
}  // namespace canyon::study
