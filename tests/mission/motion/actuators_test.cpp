#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/mission/motion/actuators/actuator.h"
#include "canyon/mission/motion/plan/speed_control.h"
#include "canyon/mission/motion/vehicle_config.h"

namespace canyon::mission {
namespace {

// y' = (u - y) / T, held at the largest rate while |u - y| is above rate x T: one step of any length is what many short
// ones make of it, to rounding.
TEST(Actuators, FirstOrderIsExactAtAnyStep) {
  for (const double wanted : {-2.0, 0.3, 5.0})
    for (const double lag_s : {0.0, 0.05, 0.7})
      for (const double rate : {0.5, 4.0, 1e3})
        for (const double dt_s : {0.01, 0.4, 3.0}) {
          double many = 0.25;
          for (int k = 0; k < 100; ++k) many = first_order_after(many, wanted, dt_s / 100, lag_s, rate);
          EXPECT_NEAR(first_order_after(0.25, wanted, dt_s, lag_s, rate), many, 1e-12) << wanted << " " << lag_s;
        }
}

TEST(Actuators, FirstOrderHasItsTimeConstantAndItsRate) {
  EXPECT_NEAR(first_order_after(0.0, 1.0, 0.3, 0.3, 1e6), 1.0 - std::exp(-1.0), 1e-15);
  EXPECT_NEAR(first_order_after(0.0, 1.0, 0.2, 0.1, 2.0), 0.4, 1e-15) << "0.8 are missing at the rate";
  // From 1 down to 0.2 missing takes 0.4 s at 2 / s; after that 0.1 s of the exponential.
  EXPECT_NEAR(first_order_after(0.0, 1.0, 0.5, 0.1, 2.0), 1.0 - 0.2 * std::exp(-1.0), 1e-15);
}

// A drive that lags is made up for by a calmer control: critically damped, so the speed is passed by nothing but what
// the limit of acceleration, which the loop does not know, adds.
TEST(Actuators, ALaggingDriveHardlyOvershoots) {
  VehicleConfig config;
  config.drive.name = "first_order";
  SpeedControl control(config);
  double most = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const DriveCommand command{4.0, 0.0};
    const double way = control.direction(command);
    control.end(control.planned(command, 0.01), way, 0.01);
    most = std::max(most, control.speed_m_s());
  }
  EXPECT_NEAR(control.speed_m_s(), 4.0, 1e-6);
  EXPECT_LT(most, 4.0 + 0.1);
}

}  // namespace
}  // namespace canyon::mission
