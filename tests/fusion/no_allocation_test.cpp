// A filter that runs for days in a vehicle asks for no memory once it runs.
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/counted_allocations.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

using canyon::testing::DrivenTruth;

TEST(CountedAllocations, SeeWhoAsksForMemory) {
  const std::int64_t before = canyon::testing::allocations();
  const auto one = std::make_unique<int>(1);
  EXPECT_EQ(canyon::testing::allocations() - before, 1) << "operator new";
  const Eigen::VectorXd other = Eigen::VectorXd::Zero(100);
  EXPECT_EQ(canyon::testing::allocations() - before, 2) << "Eigen";
}

struct Carried {
  const char* name;
  const char* keys;
  int states;
};
class NoAllocation : public ::testing::TestWithParam<Carried> {};

constexpr const char* kMeasurements =
    "\nmeasurements = [\"position\", \"velocity\", \"odometer\", \"non_holonomic\", \"standstill\"]";

/// Drives for four seconds and stands for as many: wheels and constraint ten times a second, fixes twice.
DrivenTruth::Motion stop_and_go(double t_s) {
  const double phase_s = std::fmod(t_s, 8.0);
  if (phase_s >= 4.0) return {};
  return {{0.0, 0.0, 0.1}, {phase_s < 2.0 ? 1.0 : -1.0, 0.1 * (2.0 - std::abs(phase_s - 2.0)), 0.0}};
}

TEST_P(NoAllocation, PerStepOnceWarm) {
  DrivenTruth truth(31, 0.4, 100.0, stop_and_go);
  truth.stand();
  ErrorStateFilter filter(configured(GetParam().keys + std::string(kMeasurements)), tactical_noise(),
                          DrivenTruth::frame(), Eigen::Vector3d::Zero(), {0.0, 0.3, 1.2});
  filter.initialize(DrivenTruth::start(), truth.X_WB(), truth.v_W());
  ASSERT_EQ(filter.state().size(), GetParam().states);

  std::int64_t in_predict = 0, in_update = 0;
  std::map<std::string, int> taken;
  for (int k = 1; k <= 3200; ++k) {
    const ImuSample sample = truth.step();
    GnssFix fix = truth.fix({0.1, -0.2, 0.3}, 1.0, {0.0, 0.3, 1.2});
    fix.v_A_E = truth.state().v_EU_E;
    fix.velocity_covariance_E = 0.01 * Eigen::Matrix3d::Identity();
    OdometerSample wheel;
    wheel.t = sample.t;
    wheel.dt_s = 0.1;
    wheel.speed_m_s = (truth.state().R_EU.conjugate() * truth.state().v_EU_E).x();
    const AidingMessage odometer = wheel;

    const std::int64_t before = canyon::testing::allocations();
    filter.predict(sample);
    const std::int64_t between = canyon::testing::allocations();
    const bool fixed = k % 50 == 0;
    const UpdateReport report = fixed ? filter.update(fix) : UpdateReport{};
    if (k % 10 == 0) filter.update(odometer);
    const std::int64_t after = canyon::testing::allocations();
    if (k <= 1600) continue;  // warm: everything has been there once
    in_predict += between - before;
    in_update += after - between;
    if (fixed) taken[report.measurement] += report.accepted ? 1 : 0;
    for (const UpdateReport& one : filter.reports()) taken[one.measurement] += one.accepted ? 1 : 0;
  }
  EXPECT_EQ(in_predict, 0);
  EXPECT_EQ(in_update, 0);
  for (const char* one : {"position", "velocity", "odometer", "non_holonomic", "standstill"})
    EXPECT_GT(taken[one], 10) << one;
}
INSTANTIATE_TEST_SUITE_P(
    Filters, NoAllocation,
    ::testing::Values(Carried{"of_15_states", "states = [\"biases\"]", 15},
                      Carried{"of_33_states", "states = [\"biases\", \"gains\"]", 33},
                      Carried{"vehicle", "filter = \"vehicle\"", 43},
                      Carried{"with_time_offset",
                              "filter = \"vehicle\"\nstates = [\"biases\", \"gains\", \"time_offset\"]", 34}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace canyon::fusion
