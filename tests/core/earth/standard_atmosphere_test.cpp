#include "canyon/core/earth/standard_atmosphere.h"

#include <gtest/gtest.h>

namespace canyon {
namespace {

// ISO 2533 tabulates 101325 Pa at 0, 89874.6 Pa at 1000 and 54019.9 Pa at 5000 m, to its last digit.
TEST(StandardAtmosphere, HasTheTabulatedPressures) {
  EXPECT_DOUBLE_EQ(standard_pressure_pa(0.0), 101325.0);
  EXPECT_NEAR(standard_pressure_pa(1000.0), 89874.6, 0.05);
  EXPECT_NEAR(standard_pressure_pa(5000.0), 54019.9, 0.05);
  for (const double h_m : {-1500.0, 0.0, 123.4, 9000.0})
    EXPECT_NEAR(standard_height_m(standard_pressure_pa(h_m)), h_m, 1e-8);
  EXPECT_EQ(standard_pressure_pa(20000.0), standard_pressure_pa(11000.0));
}

}  // namespace
}  // namespace canyon
