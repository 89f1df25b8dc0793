#include "canyon/lidar/map_quality/trajectory_error.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon::lidar {
namespace {

constexpr GpsTime kBegin{1'000'000'000'000'000'000};

/// A winding climb, and an estimate that lies elsewhere, turned, with noise.
struct Drive {
  Trajectory truth, estimate;
};
Drive winding(const Pose& laid, double noise_m) {
  const RandomStream random(7, "test.winding");
  Drive out;
  for (std::uint64_t k = 0; k <= 1200; ++k) {
    const double s = 0.25 * static_cast<double>(k);
    const Pose X{rotation_from({.yaw_rad = 0.02 * s, .pitch_rad = 0.01 * std::sin(0.1 * s), .roll_rad = 0.02}),
                 {40.0 * std::sin(0.02 * s), 40.0 * std::cos(0.02 * s), 3.0 * std::sin(0.013 * s)}};
    const GpsTime t = kBegin + 0.1 * static_cast<double>(k);
    out.truth.append({t, X});
    Vector6d xi;
    xi << 0.01 * random.normal3(k, 0), noise_m * random.normal3(k, 1);
    out.estimate.append({t, laid * X * Pose::exp(xi)});
  }
  return out;
}

// The second computation: homogeneous matrices, Horn's quaternion for the rotation, the angle from |R - I|.
using Matrices = std::vector<Eigen::Matrix4d>;
Matrices matrices(const Trajectory& trajectory) {
  Matrices out;
  for (const StampedPose& pose : trajectory.poses()) out.push_back(pose.X_WB.matrix());
  return out;
}

double rotation_deg(const Eigen::Matrix4d& T) {
  const double chord = (T.topLeftCorner<3, 3>() - Eigen::Matrix3d::Identity()).norm();
  return 2.0 * std::asin(chord / (2.0 * std::sqrt(2.0))) / kDegree;
}

/// Horn, J. Opt. Soc. Am. A 4 (1987) 629.
Eigen::Matrix4d horn(const Matrices& truth, const Matrices& estimate) {
  Eigen::Vector3d mean_t = Eigen::Vector3d::Zero(), mean_e = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    mean_t += truth[i].topRightCorner<3, 1>() / static_cast<double>(truth.size());
    mean_e += estimate[i].topRightCorner<3, 1>() / static_cast<double>(truth.size());
  }
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < truth.size(); ++i)
    M += (estimate[i].topRightCorner<3, 1>() - mean_e) * (truth[i].topRightCorner<3, 1>() - mean_t).transpose();
  Eigen::Matrix4d N;
  N << M.trace(), M(1, 2) - M(2, 1), M(2, 0) - M(0, 2), M(0, 1) - M(1, 0),  //
      M(1, 2) - M(2, 1), M(0, 0) - M(1, 1) - M(2, 2), M(0, 1) + M(1, 0), M(2, 0) + M(0, 2), M(2, 0) - M(0, 2),
      M(0, 1) + M(1, 0), M(1, 1) - M(0, 0) - M(2, 2), M(1, 2) + M(2, 1), M(0, 1) - M(1, 0), M(2, 0) + M(0, 2),
      M(1, 2) + M(2, 1), M(2, 2) - M(0, 0) - M(1, 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(N);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  T.topRightCorner<3, 1>() = mean_t - T.topLeftCorner<3, 3>() * mean_e;
  return T;
}

/// With places in the plane as complex numbers the turn is one of length 1, and least squares have it along the sum of
/// truth times conjugate estimate.
Eigen::Matrix4d turned_in_the_plane(const Matrices& truth, const Matrices& estimate) {
  const auto n = static_cast<double>(truth.size());
  const auto place = [](const Eigen::Matrix4d& T) { return std::complex<double>(T(0, 3), T(1, 3)); };
  std::complex<double> mean_t, mean_e, sum;
  double up = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    mean_t += place(truth[i]) / n;
    mean_e += place(estimate[i]) / n;
    up += (truth[i](2, 3) - estimate[i](2, 3)) / n;
  }
  for (std::size_t i = 0; i < truth.size(); ++i)
    sum += (place(truth[i]) - mean_t) * std::conj(place(estimate[i]) - mean_e);
  const std::complex<double> turn = sum / std::abs(sum), shift = mean_t - turn * mean_e;
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<2, 2>() << turn.real(), -turn.imag(), turn.imag(), turn.real();
  T.topRightCorner<3, 1>() << shift.real(), shift.imag(), up;
  return T;
}

/// 1e-9 is asked for; n eps scale is less: sums of 1201 squares of 1e2 m, and roots of them.
void expect_absolute_errors(const TrajectoryErrors& found, const Matrices& truth, const Matrices& estimate,
                            const Eigen::Matrix4d& T, const char* alignment) {
  constexpr double kAsked = 1e-9;
  std::vector<double> off_m;
  double sum_m = 0.0, squares_m2 = 0.0, squares_deg2 = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Matrix4d there = T * estimate[i];
    off_m.push_back((there - truth[i]).topRightCorner<3, 1>().norm());
    sum_m += off_m.back();
    squares_m2 += off_m.back() * off_m.back();
    squares_deg2 += std::pow(rotation_deg(truth[i].inverse() * there), 2);
  }
  std::sort(off_m.begin(), off_m.end());
  ASSERT_EQ(off_m.size() % 2, 1U) << "one stands in the middle";
  const auto n = static_cast<double>(truth.size());
  EXPECT_NEAR(found.ate_rms_m, std::sqrt(squares_m2 / n), kAsked) << alignment;
  EXPECT_NEAR(found.ate_mean_m, sum_m / n, kAsked) << alignment;
  EXPECT_NEAR(found.ate_median_m, off_m[off_m.size() / 2], kAsked) << alignment;
  EXPECT_NEAR(found.ate_max_m, off_m.back(), kAsked) << alignment;
  EXPECT_NEAR(found.rotation_rms_deg, std::sqrt(squares_deg2 / n), kAsked) << alignment;
}

const Pose kLaid{rotation_from({.yaw_rad = 0.7, .pitch_rad = 0.1, .roll_rad = -0.2}), {100.0, -20.0, 5.0}};

TEST(TrajectoryErrors, EqualASecondComputation) {
  const Drive drive = winding(kLaid, 0.3);
  const Matrices truth = matrices(drive.truth), estimate = matrices(drive.estimate);
  const TrajectoryErrors aligned = trajectory_errors(drive.truth, drive.estimate, TrajectoryAlignment::kSe3);
  EXPECT_EQ(aligned.poses, 1201);
  expect_absolute_errors(aligned, truth, estimate, horn(truth, estimate), "se3");
  expect_absolute_errors(trajectory_errors(drive.truth, drive.estimate, TrajectoryAlignment::kYaw), truth, estimate,
                         turned_in_the_plane(truth, estimate), "yaw");
  const TrajectoryErrors plain = trajectory_errors(drive.truth, drive.estimate, TrajectoryAlignment::kNone);
  expect_absolute_errors(plain, truth, estimate, Eigen::Matrix4d::Identity(), "none");

  std::vector<double> way{0.0};
  for (std::size_t i = 1; i < truth.size(); ++i)
    way.push_back(way.back() + (truth[i] - truth[i - 1]).topRightCorner<3, 1>().norm());
  const auto check = [&](const RelativeErrors& r, const std::function<bool(std::size_t, std::size_t)>& far_enough) {
    double m2 = 0.0, deg2 = 0.0;
    std::int64_t count = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      for (std::size_t j = i; j < truth.size(); ++j) {
        if (!far_enough(i, j)) continue;
        const Eigen::Matrix4d E = (truth[i].inverse() * truth[j]).inverse() * (estimate[i].inverse() * estimate[j]);
        m2 += E.topRightCorner<3, 1>().squaredNorm();
        deg2 += std::pow(rotation_deg(E), 2);
        ++count;
        break;
      }
    EXPECT_EQ(r.pairs, count) << r.over;
    EXPECT_NEAR(r.translation_rms_m, std::sqrt(m2 / static_cast<double>(count)), 1e-9) << r.over;
    EXPECT_NEAR(r.rotation_rms_deg, std::sqrt(deg2 / static_cast<double>(count)), 1e-9) << r.over;
  };
  const double steps[] = {1.0, 10.0, 100.0};
  for (std::size_t k = 0; k < 3; ++k)
    check(plain.relative[k], [&](std::size_t i, std::size_t j) { return way[j] - way[i] >= steps[k]; });
  const std::size_t samples[] = {10, 100};
  for (std::size_t k = 0; k < 2; ++k)
    check(plain.relative[3 + k], [&](std::size_t i, std::size_t j) { return j - i >= samples[k]; });
  EXPECT_EQ(plain.relative[1].over, "10 m");
  EXPECT_EQ(plain.relative[4].over, "10 s");
}

TEST(TrajectoryErrors, AlignmentFindsHowItWasLaid) {
  const Drive drive = winding(kLaid, 0.0);
  // Attitude noise alone: positions are exact, so the alignment is to rounding.
  const TrajectoryErrors e = trajectory_errors(drive.truth, drive.estimate, TrajectoryAlignment::kSe3);
  EXPECT_TRUE(e.alignment_determined);
  EXPECT_LT((e.X_true_estimated.inverse().p - kLaid.p).norm(), 1e-9);
  EXPECT_LT(e.ate_max_m, 1e-9);
  const Pose turned{rotation_from({.yaw_rad = -1.1}), {3.0, 4.0, 5.0}};
  const Drive level = winding(turned, 0.0);
  EXPECT_LT(trajectory_errors(level.truth, level.estimate, TrajectoryAlignment::kYaw).ate_max_m, 1e-9);
  // A tilt is no yaw: 0.1 rad over 40 m stays.
  EXPECT_GT(trajectory_errors(drive.truth, drive.estimate, TrajectoryAlignment::kYaw).ate_rms_m, 1.0);
}

TEST(TrajectoryErrors, WhatIsNotDeterminedIsSaid) {
  Trajectory straight;
  for (int k = 0; k < 50; ++k) straight.append({kBegin + 0.1 * k, {Eigen::Quaterniond::Identity(), {0.5 * k, 0, 0}}});
  EXPECT_FALSE(trajectory_errors(straight, straight, TrajectoryAlignment::kSe3).alignment_determined);
  EXPECT_TRUE(trajectory_errors(straight, straight, TrajectoryAlignment::kYaw).alignment_determined);
  const TrajectoryErrors same = trajectory_errors(straight, straight, TrajectoryAlignment::kNone);
  EXPECT_EQ(same.ate_rms_m, 0.0);
  EXPECT_EQ(same.relative[2].pairs, 0) << "24.5 m hold no stretch of 100 m";
  EXPECT_TRUE(std::isnan(same.relative[2].translation_rms_m));
  const TrajectoryErrors none = trajectory_errors(straight, {}, TrajectoryAlignment::kSe3);
  EXPECT_EQ(none.poses, 0);
  EXPECT_TRUE(std::isnan(none.ate_rms_m));
}

/// A zigzag along x whose ways from it are `wide_m`, and an estimate that is `off_m` too high or too low by turns that
/// have nothing in common with x or with the zigzag: by least squares it stays as it is.
Drive zigzag(double wide_m, double off_m) {
  constexpr double kSide[] = {1, -1, -1, 1, 1, -1, -1, 1}, kOff[] = {1, -1, -1, 1, -1, 1, 1, -1};
  Drive out;
  for (int k = 0; k < 800; ++k) {
    const Eigen::Vector3d p(0.25 * k, wide_m * kSide[k % 8], 0.0), off(0.0, 0.0, off_m * kOff[k % 8]);
    out.truth.append({kBegin + 0.1 * k, {Eigen::Quaterniond::Identity(), p}});
    out.estimate.append({kBegin + 0.1 * k, {Eigen::Quaterniond::Identity(), p + off}});
  }
  return out;
}

// 2026-11-30: of a straight drive that was estimated with noise SE(3) was "determined", and turned about it by 20
// degrees. Of the zigzag the turn about its line is known to errors across it over its width: off / sqrt(2), rms over
// both directions, by wide. How many poses there are says nothing.
TEST(TrajectoryErrors, ATurnThatIsKnownToADegreeIsDetermined) {
  const auto determined = [](const Drive& drive, TrajectoryAlignment alignment = TrajectoryAlignment::kSe3) {
    return trajectory_errors(drive.truth, drive.estimate, alignment).alignment_determined;
  };
  const double wide_m = 2.0, just_m = std::sqrt(2.0) * kDegree * wide_m;
  EXPECT_TRUE(determined(zigzag(wide_m, 0.99 * just_m)));
  EXPECT_FALSE(determined(zigzag(wide_m, 1.01 * just_m)));
  EXPECT_TRUE(determined(zigzag(wide_m, 0.0)));
  EXPECT_TRUE(determined(zigzag(wide_m, 1.01 * just_m), TrajectoryAlignment::kYaw)) << "by the way's whole length";
}

TEST(TrajectoryErrors, AStraightWayDeterminesNoTurnAboutItWhateverItsNoise) {
  const RandomStream random(7, "test.straight");
  const auto noisy = [&](const std::function<Eigen::Vector3d(double)>& place, double truth_m, double estimate_m,
                         TrajectoryAlignment alignment) {
    Trajectory truth, estimate;
    for (std::uint64_t k = 0; k < 120; ++k) {
      const GpsTime t = kBegin + 0.1 * static_cast<double>(k);
      const Eigen::Vector3d p = place(static_cast<double>(k) / 119.0);
      truth.append({t, {Eigen::Quaterniond::Identity(), p + truth_m * random.normal3(k, 0)}});
      estimate.append({t, kLaid * Pose{Eigen::Quaterniond::Identity(), p + estimate_m * random.normal3(k, 1)}});
    }
    return trajectory_errors(truth, estimate, alignment).alignment_determined;
  };
  const auto straight = [](double share) { return Eigen::Vector3d(60.0 * share, 0.0, 0.0); };
  const auto quarter = [](double share) {
    return Eigen::Vector3d(40.0 * std::sin(1.5 * share), 40.0 * std::cos(1.5 * share), 0.0);
  };
  const auto square = [](double share) {
    const double s = 4.0 * share, x = std::clamp(s, 0.0, 1.0) - std::clamp(s - 2.0, 0.0, 1.0),
                 y = std::clamp(s - 1.0, 0.0, 1.0) - std::clamp(s - 3.0, 0.0, 1.0);
    return Eigen::Vector3d(30.0 * x, 30.0 * y, 0.0);
  };
  const auto standing = [](double) { return Eigen::Vector3d(5.0, 6.0, 7.0); };
  using enum TrajectoryAlignment;
  for (const double truth_m : {0.0, 0.01}) {
    EXPECT_FALSE(noisy(straight, truth_m, 0.01, kSe3)) << truth_m;
    EXPECT_TRUE(noisy(quarter, truth_m, 0.01, kSe3)) << truth_m;
    EXPECT_TRUE(noisy(square, truth_m, 0.01, kSe3)) << truth_m;
    EXPECT_FALSE(noisy(standing, truth_m, 0.01, kYaw)) << truth_m;
  }
  EXPECT_FALSE(noisy(straight, 0.0, 0.0, kSe3));
  EXPECT_TRUE(noisy(quarter, 0.0, 0.0, kSe3)) << "nothing but rounding is left, and far less than its width";
  EXPECT_TRUE(noisy(square, 0.0, 0.0, kSe3));
  EXPECT_FALSE(noisy(standing, 0.0, 0.0, kSe3));
}

// 2026-11-30: of poses 25 m apart "over 1 m" was of pairs 25 m apart. What is twice as far or farther is another
// stretch.
TEST(TrajectoryErrors, StretchesAreLessThanTwiceWhatIsSaid) {
  const auto relative = [](double apart_m, double apart_s) {
    Trajectory truth;
    for (int k = 0; k < 9; ++k)
      truth.append({kBegin + apart_s * k, {Eigen::Quaterniond::Identity(), {apart_m * k, 0, 0}}});
    return trajectory_errors(truth, truth, TrajectoryAlignment::kNone).relative;
  };
  using Pairs = std::vector<std::int64_t>;
  const auto pairs = [&](double apart_m, double apart_s) {
    Pairs out;
    for (const RelativeErrors& r : relative(apart_m, apart_s)) out.push_back(r.pairs);
    return out;
  };
  // Over 1, 10, 100 m, 1 s and 10 s, of nine poses.
  EXPECT_EQ(pairs(25.0, 5.0), (Pairs{0, 0, 5, 0, 7}));
  EXPECT_EQ(pairs(1.9, 1.5), (Pairs{8, 3, 0, 8, 2}));
  EXPECT_EQ(pairs(2.0, 2.0), (Pairs{0, 4, 0, 0, 4}));
  EXPECT_TRUE(std::isnan(relative(25.0, 5.0)[0].translation_rms_m));
  EXPECT_TRUE(std::isnan(relative(25.0, 5.0)[0].rotation_rms_deg));
}

TEST(TrajectoryErrors, TumAndKittiReadBack) {
  const Drive drive = winding(kLaid, 0.2);
  const std::string stem = canyon::testing::temporary_file("trajectory");
  ASSERT_TRUE(write_tum(stem + ".tum", drive.estimate).ok());
  ASSERT_TRUE(write_kitti(stem + ".kitti", drive.estimate).ok());
  const auto tum = read_tum(stem + ".tum");
  const auto kitti = read_kitti(stem + ".kitti", kBegin, 10.0);
  ASSERT_TRUE(tum.ok() && kitti.ok());
  const auto errors = [&](const Trajectory& t) {
    return trajectory_errors(drive.truth, t, TrajectoryAlignment::kNone).ate_rms_m;
  };
  EXPECT_EQ(errors(*tum), errors(drive.estimate));
  EXPECT_NEAR(errors(*kitti), errors(drive.estimate), 1e-12) << "positions to the bit, rotations are no quaternions";
}

}  // namespace
}  // namespace canyon::lidar
