// What the compiler is asked to leave alone: a number is what the source computes, whatever it is optimised to.
#include <cmath>
#include <vector>

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

// 2026-11-27: where two numbers side by side are converted to single precision and back, g++ 12 drops both conversions.
TEST(Compiler, RoundsToSinglePrecisionWhereItIsAsked) {
  volatile double given = 0.1;  // that nothing is computed beforehand
  const double tenth = given;
  double x[2] = {tenth, 2.0 * tenth};
  round_both(x);
  EXPECT_EQ(x[0], 0.100000001490116119384765625);
  EXPECT_EQ(x[1], 0.20000000298023223876953125);
  std::vector<double> many(64, tenth);
  for (double& each : many) each = static_cast<double>(static_cast<float>(each));
  EXPECT_EQ(many, std::vector<double>(64, x[0]));
  EXPECT_EQ(rounded(Eigen::Vector3d(tenth, 2.0 * tenth, tenth)), Eigen::Vector3d(x[0], x[1], x[0]));
}

#if defined(__x86_64__) && !defined(__clang__)
/// By the one instruction for both where the processor has it; clang 14 makes no such choice
/// (core/process/vector_clones.h).
[[gnu::noinline, gnu::target_clones("fma", "default")]] double product_and_sum(const double* x) {
  return x[0] * x[1] + x[2];
}

// A product and a sum are rounded each by itself.
TEST(Compiler, ContractsNoProductAndSum) {
  volatile double given = 1.0 + std::ldexp(1.0, -30);
  const double x[3] = {given, given, -1.0 - std::ldexp(1.0, -29)};
  EXPECT_EQ(product_and_sum(x), 0.0);
  EXPECT_EQ(std::fma(x[0], x[1], x[2]), std::ldexp(1.0, -60));
}
#endif

}  // namespace
}  // namespace canyon
