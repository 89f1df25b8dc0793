#include "canyon/fusion/estimators/estimator.h"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "canyon/core/units.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

using testing::DrivenTruth;

ErrorStateFilter filter_of(const std::string& keys) {
  return {configured(keys), tactical_noise(), DrivenTruth::frame(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
}

/// A minute of driving with a fix a second.
ErrorStateFilter driven(const std::string& keys, double seconds = 60.0) {
  DrivenTruth truth(1, 0.5);
  const RandomStream stream(2, "test.fixes");
  ErrorStateFilter filter = filter_of(keys);
  filter.initialize(truth.state().t, truth.X_WB(), truth.v_W());
  for (int k = 1; k <= static_cast<int>(100 * seconds); ++k) {
    filter.predict(truth.step());
    if (k % 100 != 0) continue;
    const auto n = static_cast<std::uint64_t>(k);
    filter.update(truth.fix({stream.normal(0, n), stream.normal(1, n), stream.normal(2, n)}, 1.0));
  }
  return filter;
}

TEST(Estimators, UdIsJosephToRounding) {
  const std::string all =
      "filter = \"vehicle\"\nmeasurements = [\"position\", \"non_holonomic\"]\nacceptance = \"huber\"\n";
  const ErrorStateFilter joseph = driven(all), ud = driven(all + "estimator = \"ud\"");
  const Eigen::MatrixXd P = joseph.covariance(), Q = ud.covariance();
  // 6,000 steps of products of 40 terms: 1e-16 * 6000 * 40 = 2e-11 of the standard deviations' product.
  const Eigen::VectorXd sigma = P.diagonal().cwiseSqrt();
  EXPECT_LT(((P - Q).array() / (sigma * sigma.transpose()).array()).abs().maxCoeff(), 1e-9);
  EXPECT_LT((joseph.nav_state().p_EU_E - ud.nav_state().p_EU_E).norm(), 1e-6);
}

/// Fixes to a micrometre where the place is known to a kilometre: P - K H P loses 18 digits of 16.
TEST(Estimators, EachKeepsTheCovarianceDefinite) {
  for (const auto& row : estimators()) {
    ErrorStateFilter filter =
        filter_of("initial_position_sigma_m = 1e3\nestimator = \"" + std::string(row.name) + "\"");
    DrivenTruth truth(3, 1.0);
    filter.initialize(truth.state().t, truth.X_WB(), truth.v_W());
    for (int k = 0; k < 300; ++k) {
      filter.predict(truth.step());
      filter.update(truth.fix({0, 0, 0}, 1e-6));
      const Eigen::MatrixXd P = filter.covariance();
      ASSERT_EQ(P, P.transpose().eval()) << row.name;
      const Eigen::VectorXd scale = P.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd correlation = scale.asDiagonal() * P * scale.asDiagonal();
      const double least =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation, Eigen::EigenvaluesOnly).eigenvalues()[0];
      // To the rounding of the eigenvalues of n x n correlations.
      ASSERT_GT(least, -33.0 * 33.0 * 2.3e-16) << row.name << " " << k;
    }
  }
}

// For small errors the three are one filter: what differs is of second order in the correction.
TEST(Estimators, InvariantErrorsAreTheUsualOnesToFirstOrder) {
  const ErrorStateFilter usual = driven(""), invariant = driven("estimator = \"invariant\"");
  const Eigen::VectorXd sigma = usual.covariance().diagonal().cwiseSqrt();
  EXPECT_LT((usual.nav_state().p_EU_E - invariant.nav_state().p_EU_E).norm(), 0.02 * sigma.segment<3>(3).norm());
  EXPECT_LT(usual.nav_state().R_EU.angularDistance(invariant.nav_state().R_EU), 0.05 * sigma.head<3>().norm());
}

/// Heading error, rad, after some seconds of fixes from a start that is `off` in heading.
double heading_error_after(const std::string& estimator, double off_rad, double seconds) {
  DrivenTruth truth(1, 0.5);
  const RandomStream stream(4, "test.fixes");
  ErrorStateFilter filter = filter_of("initial_attitude_sigma_deg_heading = 90\nestimator = \"" + estimator + "\"");
  Pose start = truth.X_WB();
  start.R = rotation_from({.yaw_rad = off_rad, .pitch_rad = 0.0, .roll_rad = 0.0}) * start.R;
  filter.initialize(truth.state().t, start, truth.v_W());
  for (int k = 1; k <= static_cast<int>(100 * seconds); ++k) {
    filter.predict(truth.step());
    if (k % 100 != 0) continue;
    const auto n = static_cast<std::uint64_t>(k);
    filter.update(truth.fix({stream.normal(0, n), stream.normal(1, n), stream.normal(2, n)}, 1.0));
  }
  return filter.nav_state().R_EU.angularDistance(truth.state().R_EU);
}

TEST(Estimators, InvariantErrorsForgiveAHeadingFarOff) {
  for (const double off_deg : {60.0, 120.0, -150.0}) {
    const double usual = heading_error_after("joseph", off_deg * kDegree, 60.0),
                 invariant = heading_error_after("invariant", off_deg * kDegree, 60.0);
    std::printf("heading %+.0f deg off: after 60 s %.2f deg, with invariant errors %.2f deg\n", off_deg,
                usual / kDegree, invariant / kDegree);
    EXPECT_LT(invariant, usual);
    EXPECT_LT(invariant, 5.0 * kDegree);
  }
}

TEST(Estimators, ACopyGoesOnByItself) {
  for (const auto& row : estimators()) {
    const std::string keys = "filter = \"vehicle\"\nestimator = \"" + std::string(row.name) + "\"";
    ErrorStateFilter one = driven(keys, 5.0), other = one;
    const Eigen::MatrixXd before = other.covariance();
    DrivenTruth truth(1, 0.5);
    for (int k = 0; k < 500; ++k) truth.step();
    const ImuSample next = truth.step();
    one.predict(next);
    one.update(truth.fix({1, 2, 3}, 1.0));
    EXPECT_EQ(other.covariance(), before) << row.name;
    other.predict(next);
    other.update(truth.fix({1, 2, 3}, 1.0));
    EXPECT_EQ(other.covariance(), one.covariance()) << row.name;
    EXPECT_EQ(other.nav_state().p_EU_E, one.nav_state().p_EU_E) << row.name;
  }
}

}  // namespace
}  // namespace canyon::fusion
