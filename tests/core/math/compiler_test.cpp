// What the compiler is asked to leave alone: a number is what the source computes, whatever it is optimised to.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace canyon {
namespace {

[[gnu::noinline]] void round_both(double* x) {
  const double first = static_cast<double>(static_cast<float>(x[0]));
  const double second = static_cast<double>(static_cast<float>(x[1]));
  x[0] = first;
  x[1] = second;
}

[[gnu::noinline]] Eigen::Vector3d rounded(const Eigen::Vector3d& v) {
  return v.cast<float>().cast<double>();
}

// 2026-11-27: g++ 12 makes vectors of two conversions, to single precision and back, and leaves both of them out.
TEST(Compiler, RoundsToSinglePrecisionWhereItIsAsked) {
  volatile double given = 0.1;  // that nothing is computed beforehand
  const double tenth = given;
  double x[2] = {tenth, 2.0 * tenth};
  round_both(x);
  EXPECT_EQ(x[0], 0.100000001490116119384765625);
  EXPECT_EQ(x[1], 0.20000000298023223876953125);
  EXPECT_EQ(rounded(Eigen::Vector3d(tenth, 2.0 * tenth, tenth)), Eigen::Vector3d(x[0], x[1], x[0]));
}

// A product and a sum are rounded each by itself.
TEST(Compiler, ContractsNoProductAndSum) {
  volatile double a = 1.0 + std::ldexp(1.0, -30), c = -1.0 - std::ldexp(1.0, -29);
  EXPECT_EQ(a * a + c, 0.0);
  EXPECT_EQ(std::fma(a, a, c), std::ldexp(1.0, -60));
}

}  // namespace
}  // namespace canyon
