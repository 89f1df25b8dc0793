#include "canyon/study/registration_error/events/event_regression.h"

#include <gtest/gtest.h>

#include "canyon/tests/study/registration_error/events/artificial_series.h"

namespace canyon::study {
namespace {

using testing::ArtificialRuns;
using testing::event_at;

/// A DOP jump, half of the time with hidden signals 3 s behind it; hidden signals alone elsewhere.
std::vector<MapEvent> overlapping(const RandomStream& stream, std::uint64_t run) {
  const double at_s = 60.0 + std::floor(100.0 * stream.uniform(0, run));
  std::vector<MapEvent> out{event_at(MapEventKind::kDilutionJump, at_s)};
  if (stream.uniform(2, run) < 0.5) out.push_back(event_at(MapEventKind::kNlosBegin, at_s + 3.0));
  if (stream.uniform(3, run) < 0.5) out.push_back(event_at(MapEventKind::kNlosBegin, at_s + 80.0));
  return out;
}
constexpr double kOfDop_m = 0.6, kOfNlos_m = -0.4;
double level_for_10_s(MapEventKind kind, double since_s) {
  if (!(since_s > 0.0 && since_s <= 10.0)) return 0.0;
  return kind == MapEventKind::kDilutionJump ? kOfDop_m : kOfNlos_m;
}
double waves(double t_s) {
  return std::sin(0.3 * t_s) + 0.01 * t_s;
}

/// Without noise the model holds exactly, and least squares gives its coefficients: n eps scale, of some 5000 rows with
/// a condition number that is not large.
TEST(EventRegression, WithoutNoiseIsExact) {
  const ArtificialRuns runs{
      .seeds = 6, .noise_m = 0.0, .place = waves, .events = overlapping, .effect = level_for_10_s};
  const auto found = regress_events(runs.make(), 0, 1);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].kind, MapEventKind::kDilutionJump);
  EXPECT_EQ(found[1].kind, MapEventKind::kNlosBegin);
  EXPECT_NEAR(found[0].effect_m.value, kOfDop_m, 1e-10);
  EXPECT_NEAR(found[1].effect_m.value, kOfNlos_m, 1e-10);
  for (std::size_t j = 0; j < found[0].by_lag.size(); ++j) {
    const bool lasts = kLagEdges_s[j + 2] <= 10.0;
    EXPECT_NEAR(found[0].by_lag[j].value, lasts ? kOfDop_m : 0.0, 1e-10) << j;
    EXPECT_NEAR(found[1].by_lag[j].value, lasts ? kOfNlos_m : 0.0, 1e-10) << j;
  }
}

TEST(EventRegression, TellsApartWhatAnAverageMixes) {
  const ArtificialRuns runs{.place = waves, .events = overlapping, .effect = level_for_10_s};
  const auto series = runs.make();
  const auto found = regress_events(series, 0, 1);
  ASSERT_EQ(found.size(), 2U);
  const auto covers = [](const EstimatedNumber& number, double value) {
    return number.interval.low <= value && value <= number.interval.high;
  };
  EXPECT_TRUE(covers(found[0].effect_m, kOfDop_m)) << found[0].effect_m.value;
  EXPECT_TRUE(covers(found[1].effect_m, kOfNlos_m)) << found[1].effect_m.value;
  const EventAverage mixed = average_events(series, MapEventKind::kDilutionJump, 0, 1);
  EXPECT_LT(mixed.effect_m.interval.high, kOfDop_m) << "the hidden signals behind half of the jumps count against them";
}

}  // namespace
}  // namespace canyon::study
