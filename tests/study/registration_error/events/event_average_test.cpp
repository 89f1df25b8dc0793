#include "canyon/study/registration_error/events/event_average.h"

#include <gtest/gtest.h>

#include "canyon/tests/study/registration_error/events/artificial_series.h"

namespace canyon::study {
namespace {

using testing::ArtificialRuns;
using testing::event_at;

constexpr double kPlanted_m = 0.5;
/// From 2 to 8 s after the event.
double planted_for_a_while(MapEventKind kind, double since_s) {
  return kind == MapEventKind::kDilutionJump && since_s >= 2.0 && since_s < 8.0 ? kPlanted_m : 0.0;
}
/// What the mean over the lags 0.5, 1, ..., 10 s makes of it: a keyframe a second, so it rises from 1 to 2 s and falls
/// from 7 to 8 s by straight lines; 0.5 at 1.5, eleven whole ones from 2 to 7, 0.5 at 7.5.
constexpr double kPlantedMean_m = kPlanted_m * (0.5 + 11.0 + 0.5) / 20.0;

/// At most one event a run, at one of the crossings at 50, 100, 150, 200 s.
std::vector<MapEvent> at_crossings(const RandomStream& stream, std::uint64_t run) {
  const double which = std::floor(stream.uniform(0, run) * 6.0);
  if (which >= 4.0) return {};
  return {event_at(MapEventKind::kDilutionJump, 50.0 * (which + 1.0))};
}
/// Crossings are bad places whatever the sky does.
double worse_at_crossings(double t_s) {
  double out = 0.0;
  for (const double at_s : {50.0, 100.0, 150.0, 200.0}) out += std::exp(-0.5 * std::pow((t_s - at_s - 3.0) / 2.0, 2));
  return out;
}

bool covers(const EstimatedNumber& number, double value) {
  return number.interval.low <= value && value <= number.interval.high;
}

TEST(EventAverage, APlantedEffectIsFoundWithItsDelayAndDuration) {
  const ArtificialRuns runs{.events = at_crossings, .effect = planted_for_a_while};
  const EventAverage found = average_events(runs.make(), MapEventKind::kDilutionJump, 0, 1);
  EXPECT_GT(found.matched, 40);
  EXPECT_TRUE(covers(found.effect_m, kPlantedMean_m)) << found.effect_m.value;
  EXPECT_LT(found.effect_m.interval.high - found.effect_m.interval.low, kPlantedMean_m);
  EXPECT_TRUE(covers(found.placebo_m, 0.0)) << found.placebo_m.value;
  EXPECT_TRUE(covers(found.null_m, 0.0)) << found.null_m.value;
  EXPECT_NEAR(found.delay_s.value, 1.5, kLagStep_s);
  EXPECT_NEAR(found.duration_s.value, 6.0, 2.0 * kLagStep_s);
}

TEST(EventAverage, WhatThePlaceDoesIsNoEffect) {
  const ArtificialRuns runs{
      .place = worse_at_crossings, .events = at_crossings, .effect = [](MapEventKind, double) { return 0.0; }};
  const EventAverage found = average_events(runs.make(), MapEventKind::kDilutionJump, 0, 1);
  EXPECT_TRUE(covers(found.effect_m, 0.0)) << found.effect_m.value;
  EXPECT_TRUE(covers(found.null_m, 0.0)) << found.null_m.value;
  EXPECT_GT(found.event_m.interval.low, 0.2) << "an average of the events alone takes the crossings for them";
  EXPECT_GT(found.placebo_m.interval.low, 0.2);
}

TEST(EventAverage, AnEventThatHappensAtEveryStartHasNoPlacebo) {
  const ArtificialRuns runs{.events = [](const RandomStream&, std::uint64_t) -> std::vector<MapEvent> {
                              return {event_at(MapEventKind::kFixLost, 100.0)};
                            },
                            .effect = planted_for_a_while};
  const auto series = runs.make();
  const EventAverage found = average_events(series, MapEventKind::kFixLost, 0, 1);
  EXPECT_EQ(found.events, 80);
  EXPECT_EQ(found.matched, 0);
  EXPECT_TRUE(std::isnan(found.effect_m.value));
  EXPECT_EQ(average_events(series, MapEventKind::kNlosBegin, 0, 1).events, 0);
}

TEST(EventAverage, WhereTheVehicleStandsThereIsNoError) {
  ErrorSeries run;
  run.t_s = {0.0, 1.0, 8.0, 9.0};
  for (const double error : {1.0, 2.0, 3.0, 5.0}) run.errors.push_back({error, error, error, error});
  EXPECT_EQ(run.at(0, 1.0), 2.0);
  EXPECT_EQ(run.at(0, 8.25), 3.5);
  EXPECT_TRUE(std::isnan(run.at(0, 4.0)));
  EXPECT_TRUE(std::isnan(run.at(0, -0.1)));
  EXPECT_TRUE(std::isnan(run.at(0, 9.1)));
}

}  // namespace
}  // namespace canyon::study
