// What is measured at each so many seconds is measured then, whether or not messages divide samples.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "canyon/fusion/divided_sample.h"
#include "canyon/fusion/error_state_filter.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

using canyon::testing::DrivenTruth;

struct Driven {
  std::vector<std::int64_t> at_ms;  // of the measurement
  Eigen::Vector3d p_W;
};

/// 10 s, all of it at rest or not, with a filter of these keys; each seventh sample comes in two parts, the first
/// `share` of it.
Driven driven(const std::string& measurement, bool at_rest, double share, const std::string& keys = "") {
  const auto motion = [&](double t_s) { return at_rest ? DrivenTruth::Motion{} : DrivenTruth::winding(t_s); };
  DrivenTruth truth(3, 0.7, 100.0, motion);
  if (at_rest) truth.stand();
  const FilterConfig config = configured("measurements = [\"position\", \"" + measurement + "\"]\n" + keys);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  ErrorStateFilter filter(config, tactical_noise(), DrivenTruth::frame(), none, none);
  filter.initialize(DrivenTruth::start(), truth.X_WB(), DrivenTruth::frame().R_EW().transpose() * truth.state().v_EU_E);
  Driven out;
  const auto predict = [&](const ImuSample& sample) {
    filter.predict(sample);
    for (const UpdateReport& report : filter.reports())
      if (report.measurement == measurement) out.at_ms.push_back(std::llround(1e3 * (report.t - DrivenTruth::start())));
  };
  for (int k = 0; k < 1000; ++k) {
    ImuSample sample = truth.step();
    if (share > 0.0 && k % 7 == 3) predict(take_share(sample, share));
    predict(sample);
  }
  out.p_W = filter.estimate().X_WB.p;
  return out;
}

// Parts of a microsecond, as where the clocks of unit and receiver are off by that, and of half a sample.
TEST(DividedSamples, LeaveTheTimesOfMeasurementsAsTheyAre) {
  for (const bool at_rest : {false, true}) {
    const std::string measurement = at_rest ? "standstill" : "non_holonomic";
    const Driven whole = driven(measurement, at_rest, 0.0);
    EXPECT_EQ(whole.at_ms.size(), at_rest ? 20u : 100u);
    for (const double share : {1.45e-4, 0.5}) {
      const Driven divided = driven(measurement, at_rest, share);
      EXPECT_EQ(divided.at_ms, whole.at_ms) << measurement << " " << share;
      // A force that turns within a sample is pushed along the middle of each part, 5e-6 m/s^2 apart at half a sample.
      EXPECT_LT((divided.p_W - whole.p_W).norm(), 0.5 * 5e-6 * 100.0) << measurement << " " << share;
    }
  }
}

// 30 times a second of samples at 100 Hz: each third or fourth, or half of one where that is in time.
TEST(DividedSamples, LeaveARateThatIsNoneOfTheUnitsAsItIs) {
  const std::string rate = "non_holonomic_rate_hz = 30";
  for (const double share : {0.0, 1.45e-4, 0.5}) {
    const Driven out = driven("non_holonomic", false, share, rate);
    ASSERT_EQ(out.at_ms.size(), 300u) << share;
    for (std::size_t i = 0; i < out.at_ms.size(); ++i) {
      const double late_ms = static_cast<double>(out.at_ms[i]) - 1e3 * static_cast<double>(i + 1) / 30.0;
      EXPECT_GT(late_ms, -0.51) << share;
      EXPECT_LT(late_ms, 10.0) << share;
    }
  }
}

}  // namespace
}  // namespace canyon::fusion
