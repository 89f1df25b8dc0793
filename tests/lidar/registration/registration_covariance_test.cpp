#include "canyon/lidar/registration/registration_covariance.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/check.h"
#include "canyon/core/random/random.h"

namespace canyon::lidar {
namespace {

constexpr double kThickness = 1e-3;

/// Matches on planes with the given normals, spread over a cube, residuals of sigma_m along the normal and none along
/// the plane: what generalized ICP assumes, with known statistics.
std::vector<Correspondence> matches(const std::vector<Eigen::Vector3d>& normals, std::uint32_t per_normal,
                                    double sigma_m, double tilt_variance, std::uint64_t seed) {
  const RandomStream random(seed, "test.matches");
  std::vector<Correspondence> out;
  std::uint64_t index = 0;
  for (const Eigen::Vector3d& normal : normals) {
    const Eigen::Matrix3d M =
        0.5 * Eigen::Matrix3d::Identity() + (0.5 / kThickness - 0.5) * normal * normal.transpose();
    for (std::uint32_t i = 0; i < per_normal; ++i, ++index) {
      const Eigen::Vector3d p(random.uniform(-30, 30, 0, index), random.uniform(-30, 30, 1, index),
                              random.uniform(-5, 5, 2, index));
      out.push_back({p, sigma_m * random.normal(3, index) * normal, M, tilt_variance});
    }
  }
  return out;
}

// 2026-11-22: the inverse of the singular curvature made the covariance NaN and nobody looked.
TEST(RegistrationPrecision, PointsOnALineDetermineNoPose) {
  std::vector<Correspondence> line;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p = Eigen::Vector3d(3, 4, 0) + 0.5 * i * Eigen::Vector3d(1, 2, 2) / 3.0;
    line.push_back({p, Eigen::Vector3d::Zero(), 0.5 * Eigen::Matrix3d::Identity(), 0.0});
  }
  EXPECT_TRUE(registration_precision(line, Eigen::Matrix3d::Identity(), 4.0).covariance.array().isNaN().all());
  // 1 mm beside the line, of 25 m: told from it, and every direction open, since no surface says anything.
  for (std::size_t i = 0; i < line.size(); i += 2) line[i].p_S += 1e-3 * Eigen::Vector3d(2, -2, 1) / 3.0;
  const auto beside = registration_precision(line, Eigen::Matrix3d::Identity(), 4.0);
  EXPECT_TRUE(beside.covariance.allFinite());
  EXPECT_EQ(beside.unconstrained, 6);
}

const std::vector<Eigen::Vector3d> kAllDirections{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

TEST(RegistrationPrecision, IndependentResidualsGiveTheLeastSquaresCovariance) {
  const auto all = matches(kAllDirections, 2000, 0.02, 0.0, 1);
  const auto precision = registration_precision(all, Eigen::Matrix3d::Identity(), 4.0);
  Matrix6d information = Matrix6d::Zero();  // point to plane with sigma 0.02
  for (const Correspondence& match : all) {
    Eigen::Matrix<double, 3, 6> J;
    J << -skew(match.p_S), Eigen::Matrix3d::Identity();
    information += J.transpose() * match.information * J / (0.5 / kThickness) / (0.02 * 0.02);
  }
  const Matrix6d expected = information.inverse();
  EXPECT_EQ(precision.unconstrained, 0);
  EXPECT_NEAR(precision.rms_m / 0.02, 1.0, 4.5 / std::sqrt(2 * 6000.0));  // 4.5 sigma: false alarms 7e-6
  // B is a scatter over some 225 x 3 blocks: relative standard deviation sqrt(2 / 675) = 0.054.
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(precision.covariance(k, k) / expected(k, k), 1.0, 4.5 * 0.054) << k;
}

TEST(RegistrationPrecision, CorrelatedResidualsCountAsOne) {
  // Ten copies of every match say no more than one; the least-squares form would claim a tenth of the variance.
  const auto once = matches(kAllDirections, 600, 0.02, 0.0, 2);
  std::vector<Correspondence> copies;
  for (int c = 0; c < 10; ++c) copies.insert(copies.end(), once.begin(), once.end());
  const Matrix6d a = registration_precision(once, Eigen::Matrix3d::Identity(), 4.0).covariance;
  const Matrix6d b = registration_precision(copies, Eigen::Matrix3d::Identity(), 4.0).covariance;
  // All but the independent 1 mm that is always added: (1 / 20)^2 of the variance.
  EXPECT_LT((a - b).norm(), 0.0025 * a.norm());
}

TEST(RegistrationPrecision, ACorridorIsOpenAlongItself) {
  // Walls across y, floor across z, nothing across x; the normals err by 1 deg, as fitted ones do.
  const double tilt = 1.0 / 57.3;
  const RandomStream random(3, "test.tilt");
  std::vector<Correspondence> all;
  std::uint64_t index = 0;
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
    for (int i = 0; i < 3000; ++i, ++index) {
      const Eigen::Vector3d tilted = (normal + tilt * random.normal3(index)).normalized();
      auto one = matches({tilted}, 1, 0.02, tilt * tilt, index + 10);
      all.push_back(one[0]);
    }
  }
  const auto precision = registration_precision(all, Eigen::Matrix3d::Identity(), 4.0);
  EXPECT_EQ(precision.unconstrained, 1);
  EXPECT_GT(std::sqrt(precision.covariance(3, 3)), 0.9 * kUnconstrainedSigma_m);
  for (const int k : {4, 5}) EXPECT_LT(std::sqrt(precision.covariance(k, k)), 0.01) << k;
  for (const int k : {0, 1, 2}) EXPECT_LT(std::sqrt(precision.covariance(k, k)), 0.002) << k;
}

TEST(RegistrationPrecision, IsExpressedInTheSourceFrame) {
  // The same geometry seen from a source turned by 90 deg: x and y change places.
  const Eigen::Matrix3d R_TS = rotation_from({.yaw_rad = 1.5707963267948966}).toRotationMatrix();
  auto all = matches({{1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0, 1}}, 1000, 0.02, 0.0, 4);
  const Matrix6d straight = registration_precision(all, Eigen::Matrix3d::Identity(), 4.0).covariance;
  for (Correspondence& match : all) match.p_S = R_TS.transpose() * match.p_S;
  const Matrix6d turned = registration_precision(all, R_TS, 4.0).covariance;
  EXPECT_GT(straight(3, 3), 2 * straight(4, 4));
  EXPECT_GT(turned(4, 4), 2 * turned(3, 3));
}

TEST(RegistrationPrecision, IsSymmetricAndPositive) {
  for (const double sigma_m : {0.0, 1e-9, 0.02, 1.0}) {
    for (const std::uint32_t count : {5u, 40u, 1000u}) {
      const auto precision =
          registration_precision(matches(kAllDirections, count, sigma_m, 1e-4, 5), Eigen::Matrix3d::Identity(), 8.0);
      EXPECT_EQ(precision.covariance, precision.covariance.transpose());
      ASSERT_TRUE(precision.covariance.allFinite());
      const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(precision.covariance);
      EXPECT_GT(eigen.eigenvalues().minCoeff(), 0) << sigma_m << " m, " << count;
    }
  }
  EXPECT_THROW(registration_precision(matches(kAllDirections, 2, 0.02, 0, 6), Eigen::Matrix3d::Identity(), 8.0),
               ProgramError);
}

}  // namespace
}  // namespace canyon::lidar
