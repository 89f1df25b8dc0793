#include "canyon/report/draw/axis.h"

#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/check.h"

namespace canyon::report {
namespace {

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> out;
  for (const Tick& tick : axis.ticks()) out.push_back(tick.label);
  return out;
}
using Labels = std::vector<std::string>;

TEST(Axis, StepsAreOneTwoOrFive) {
  EXPECT_DOUBLE_EQ(nice_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(nice_step(1, 5), 0.2);
  EXPECT_DOUBLE_EQ(nice_step(0.7, 3), 0.5);
  EXPECT_DOUBLE_EQ(nice_step(1000, 4), 500);
  for (double range = 1e-6; range < 1e9; range *= 1.37) {
    const double step = nice_step(range, 5);
    const double mantissa = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-9 || std::abs(mantissa - 2) < 1e-9 || std::abs(mantissa - 5) < 1e-9)
        << range;
    EXPECT_LE(range / step, 5 * (1 + 1e-9));
    EXPECT_GT(range / step, 1.9);
  }
}

TEST(Axis, LinearTicksHaveExactLabels) {
  EXPECT_EQ(labels(Axis::linear(0, 1)), (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1"}));
  EXPECT_EQ(labels(Axis::linear_rounded(-7.3, 12.1, 4)), (Labels{"\xE2\x88\x92"
                                                                 "10",
                                                                 "\xE2\x88\x92"
                                                                 "5",
                                                                 "0", "5", "10", "15"}));
  const Axis axis = Axis::linear_rounded(-7.3, 12.1, 4);
  EXPECT_DOUBLE_EQ(axis.min(), -10);
  EXPECT_DOUBLE_EQ(axis.max(), 15);
}

TEST(Axis, AnEmptyRangeIsWidened) {
  const Axis axis = Axis::linear(3, 3);
  EXPECT_LT(axis.min(), 3);
  EXPECT_GT(axis.max(), 3);
  EXPECT_GE(Axis::linear(0, 0).ticks().size(), 2u);
}

TEST(Axis, TimeTicksAreRoundInMinutes) {
  EXPECT_EQ(labels(Axis::seconds(0, 480)), (Labels{"0", "60", "120", "180", "240", "300", "360", "420", "480"}));
  EXPECT_EQ(labels(Axis::seconds(0, 100)), (Labels{"0", "15", "30", "45", "60", "75", "90"}));
  EXPECT_EQ(labels(Axis::seconds(0, 7200)),
            (Labels{"0", "900", "1800", "2700", "3600", "4500", "5400", "6300", "7200"}));
}

TEST(Axis, LogarithmicTicks) {
  EXPECT_EQ(labels(Axis::logarithmic(1.3, 27)), (Labels{"1", "2", "5", "10", "20", "50"}));
  EXPECT_EQ(labels(Axis::logarithmic(2.1, 4.9)), (Labels{"2", "3", "4", "5"}));  // finer within one decade
  EXPECT_EQ(labels(Axis::logarithmic(0.011, 0.02)), (Labels{"0.01", "0.015", "0.02"}));
  // Over more than three decades only the powers of ten are named.
  EXPECT_EQ(labels(Axis::logarithmic(0.012, 31)), (Labels{"0.01", "", "", "0.1", "", "", "1", "", "", "10", "", ""}));
  const Axis axis = Axis::logarithmic(0.012, 31);
  EXPECT_DOUBLE_EQ(axis.min(), 0.01);
  EXPECT_DOUBLE_EQ(axis.max(), 50);
}

TEST(Axis, PlacesAndValuesAreInverse) {
  for (const Axis& axis : {Axis::linear(-3, 8), Axis::logarithmic(0.02, 70)}) {
    EXPECT_DOUBLE_EQ(axis.place(axis.min()), 0);
    EXPECT_DOUBLE_EQ(axis.place(axis.max()), 1);
    for (double place = 0; place <= 1; place += 0.125) {
      // A logarithm and a power: a few roundings.
      EXPECT_NEAR(axis.place(axis.value_at(place)), place, 16 * 2.3e-16);
    }
  }
  EXPECT_EQ(Axis::logarithmic(1, 10).place(0), -1);
  EXPECT_EQ(Axis::logarithmic(1, 10).place(-5), -1);
}

TEST(Axis, RefusesWhatIsNoRange) {
  EXPECT_THROW(Axis::logarithmic(0, 1), ProgramError);
  EXPECT_THROW(Axis::linear(2, 1), ProgramError);
  EXPECT_THROW(Axis::linear(std::nan(""), 1), ProgramError);
}

TEST(Axis, WholeDecades) {
  const Axis axis = Axis::decades(0.02, 3);
  EXPECT_EQ(axis.min(), 0.01);
  EXPECT_EQ(axis.max(), 10);
  ASSERT_EQ(axis.ticks().size(), 28u);
  EXPECT_EQ(axis.ticks()[0].label, "10⁻²");
  EXPECT_EQ(axis.ticks()[1].label, "");
  EXPECT_EQ(axis.ticks()[27].label, "10¹");
  EXPECT_EQ(Axis::decades(10, 10).max(), 100) << "never empty";
}

}  // namespace
}  // namespace canyon::report
