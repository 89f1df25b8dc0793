#include "canyon/gnss/receiver/receiver_antenna.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

std::shared_ptr<const ReceiverAntenna> antenna(const char* name) {
  return *ModelChoice<antenna_models>(name).make("gnss.antenna");
}

TEST(Antenna, SineIsItsFormula) {
  const auto a = antenna("sine");
  EXPECT_EQ(a->rhcp_db(kPi / 2), 0.0);
  EXPECT_EQ(a->rhcp_db(0.0), -7.0);
  EXPECT_EQ(a->rhcp_db(-kPi / 2), -14.0);
  EXPECT_EQ(a->lhcp_db(0.0), -17.0);
  EXPECT_EQ(a->phase_centre_m(Eigen::Vector3d::UnitX()), 0.0);
}

// Every pattern: gains are relative to the zenith, right hand falls steadily from there to the horizon, the left hand
// stays below the right hand above the horizon, and all is finite and without jumps.
TEST(Antenna, PatternsAreSensible) {
  for (const auto& row : antenna_models()) {
    const auto a = antenna(row.name);
    EXPECT_NEAR(a->rhcp_db(kPi / 2), 0.0, 1e-12) << row.name;
    double before_db = a->rhcp_db(-kPi / 2), before_l_db = a->lhcp_db(-kPi / 2);
    for (double e = -90.0; e <= 90.0; e += 0.5) {
      const double right = a->rhcp_db(e * kDegree), left = a->lhcp_db(e * kDegree);
      EXPECT_GE(right, before_db - 1e-12) << row.name << " " << e;
      EXPECT_LT(std::abs(right - before_db), 0.5) << row.name << " " << e;
      EXPECT_LT(std::abs(left - before_l_db), 0.5) << row.name << " " << e;
      if (e >= 5.0) {
        EXPECT_LT(left, right) << row.name << " " << e;
      }
      before_db = right;
      before_l_db = left;
    }
  }
}

// A point 66.76 mm above the nominal one is nearer to a satellite overhead by just that; at the horizon only the
// horizontal offset and the variation count (IGS igs05.atx, NOV702GG NONE, G01).
TEST(Antenna, PhaseCentreOfASurveyAntenna) {
  const auto a = antenna("survey");
  EXPECT_NEAR(a->phase_centre_m(Eigen::Vector3d::UnitZ()), -66.76e-3, 1e-12);
  EXPECT_NEAR(a->phase_centre_m(Eigen::Vector3d::UnitY()), (1.59 - 1.35) * 1e-3, 1e-12);
  EXPECT_NEAR(a->phase_centre_m({0.0, std::cos(30 * kDegree), std::sin(30 * kDegree)}),
              (-1.00 - 1.35 * std::cos(30 * kDegree) - 66.76 * 0.5) * 1e-3, 1e-12);
  EXPECT_NEAR(antenna("choke_ring")->phase_centre_m(-Eigen::Vector3d::UnitX()), (14.88 - 0.46) * 1e-3, 1e-12);
}

}  // namespace
}  // namespace canyon::gnss
