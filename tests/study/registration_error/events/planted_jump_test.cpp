#include <gtest/gtest.h>

#include "canyon/core/process/parallel.h"
#include "canyon/mission/run.h"
#include "canyon/study/registration_error/events/error_events.h"
#include "canyon/study/registration_error/events/estimate_jumps.h"
#include "canyon/tests/study/registration_error/taped_start.h"

namespace canyon::study {
namespace {

using testing::taped_start;
using testing::TapedStart;

/// What the mapper is given, keyframe by keyframe.
struct GivenKeyframe {
  double t_s;
  NavEstimate estimate;
  RelativePose motion;
  Eigen::Vector3d p_W_true;
};
class KeepsGiven final : public mission::Recorder {
 public:
  explicit KeepsGiven(GpsTime start) : start_(start) {}
  Status keyframe_input(const mission::KeyframeInput& input) override {
    given.push_back({input.deskewed.t - start_, input.estimate, input.motion, input.X_WB_true.p});
    return Ok{};
  }
  std::vector<GivenKeyframe> given;

 private:
  GpsTime start_;
};

std::vector<GivenKeyframe> given_by(const TapedStart& on) {
  KeepsGiven recorder(on.mission.start);
  mission::Omissions nobody;
  nobody.autonomy = nobody.maps = true;
  const auto record =
      mission::run_mission(on.config, on.mission, nullptr,
                           {.tape = &on.tape, .recorder = &recorder, .autonomy = nullptr, .omissions = &nobody});
  EXPECT_TRUE(record.ok());
  return recorder.given;
}

std::vector<MapEvent> jumps_of(const std::vector<GivenKeyframe>& given) {
  EstimateJumps jumps;
  for (const GivenKeyframe& keyframe : given) jumps.add(keyframe.t_s, keyframe.estimate, keyframe.motion);
  return jumps.events();
}

ErrorSeries series_of(const std::vector<GivenKeyframe>& given) {
  ErrorSeries out;
  for (const GivenKeyframe& keyframe : given) {
    const double error_m = (keyframe.estimate.X_WB.p - keyframe.p_W_true).norm();
    out.t_s.push_back(keyframe.t_s);
    out.errors.push_back({error_m, error_m, error_m, error_m});
  }
  out.events = jumps_of(given);
  return out;
}

/// Of `low` none; and of a jump of 3 m that is laid on its estimates size, time, effect and delay. What the filter
/// corrects there anyway, c, is added to it: the size is between 3 - c and 3 + c.
TEST(PlantedJump, IsFoundWithSizeAndTimeAndNoneInLow) {
  const TapedStart on = taped_start("low", 25.0);
  const std::vector<GivenKeyframe> plain = given_by(on);
  ASSERT_GT(plain.size(), 30U);
  EXPECT_TRUE(jumps_of(plain).empty());

  constexpr double kLaidOn_m = 3.0;
  const std::size_t from = plain.size() / 2;
  std::vector<GivenKeyframe> planted = plain;
  for (std::size_t k = from; k < planted.size(); ++k) planted[k].estimate.X_WB.p.x() += kLaidOn_m;
  const std::vector<MapEvent> found = jumps_of(planted);
  ASSERT_EQ(found.size(), 1U);
  const Pose predicted = plain[from - 1].estimate.X_WB * plain[from].motion.X_TS;
  const double corrected_m = (plain[from].estimate.X_WB.p - predicted.p).norm();
  EXPECT_LT(corrected_m, 1.0);
  EXPECT_NEAR(found[0].size, kLaidOn_m, corrected_m + 1e-9);
  EXPECT_EQ(found[0].t_s, planted[from].t_s);
  EXPECT_EQ(found[0].from_s, planted[from - 1].t_s);

  const EventAverage average =
      average_events({{series_of(planted), series_of(plain)}}, MapEventKind::kEstimateJump, 0, 1);
  EXPECT_EQ(average.events, 1);
  EXPECT_EQ(average.matched, 1);
  double largest_m = 0.0;
  for (const GivenKeyframe& keyframe : plain)
    largest_m = std::max(largest_m, (keyframe.estimate.X_WB.p - keyframe.p_W_true).norm());
  EXPECT_NEAR(average.effect_m.value, kLaidOn_m, 2.0 * largest_m);
  EXPECT_EQ(average.delay_s.value, 0.0);
  EXPECT_EQ(average.duration_s.value, kAfter_s + kLagStep_s - average.delay_s.value) << "it stays";
}

TEST(ErrorEvents, SameBitsForAnyNumberOfThreads) {
  const TapedStart on = taped_start("low", 5.0);
  std::vector<std::string> tables;
  for (const int n : {1, 2, 8}) {
    set_threads(n);
    const auto events = find_error_events(on.config, on.mission, on.tape,
                                          {.fidelity = "low", .seeds = 2, .starts = 2, .show_progress = false});
    ASSERT_TRUE(events.ok()) << events.error().str();
    EXPECT_TRUE(events->registered);
    tables.push_back(error_events_csv(*events));
  }
  set_threads(0);
  EXPECT_EQ(tables[1], tables[0]);
  EXPECT_EQ(tables[2], tables[0]);
}

/// The whole built-in mission.
TEST(PlantedJumpNightly, NoJumpInLow) {
  auto file = mission::MissionFile::parse("base = \"vicksburg\"", "test.toml");
  ASSERT_TRUE(file.ok());
  const auto config = file->resolve("low");
  ASSERT_TRUE(config.ok());
  auto prepared = mission::prepare(*config, mission::testing::scenes());
  ASSERT_TRUE(prepared.ok());
  auto tape = mission::drive_route(*config, *prepared);
  ASSERT_TRUE(tape.ok());
  const TapedStart on{*config, *std::move(prepared), *std::move(tape)};
  EXPECT_TRUE(jumps_of(given_by(on)).empty());
}

}  // namespace
}  // namespace canyon::study
