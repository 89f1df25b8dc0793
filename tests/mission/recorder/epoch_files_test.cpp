#include "canyon/mission/recorder/epoch_files.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "canyon/core/units.h"
#include "canyon/tests/mission/recorder/keyframe_columns.h"

namespace canyon::mission {
namespace {

using testing::cells;
using testing::keyframe_columns;
using testing::numbers_in;

/// The last three columns of epochs/RUN_gnss.csv: accepted, nis, reason.
std::string filter_columns(const GnssRow& row) {
  CsvWriter csv(kGnssColumns);
  const GpsTime start = GpsTime::from_calendar(2010, 11, 17, 13, 0, 0.0);
  write(csv, row, {.frame = LocalFrame(Geodetic{0.56, -1.58, 60.0}), .start = start});
  const std::string text = csv.text().substr(0, csv.text().size() - 1);
  return text.substr(text.rfind(',', text.rfind(',', text.rfind(',') - 1) - 1) + 1);
}

/// A fix, and what the filter made of it.
GnssRow fix_with(bool accepted, double nis, int dimension) {
  GnssRow row;
  row.fix.status = FixStatus::kSingle;
  row.fix.p_A_E = {6.4e6, 0.0, 0.0};
  row.fix.covariance_E.setIdentity();
  row.update.accepted = accepted;
  row.update.nis = nis;
  row.update.dimension = dimension;
  return row;
}

// 2026-11-23: a fix that restarted the filter had no NIS, and nothing in its row said why.
TEST(EpochFiles, AnEmptyNisHasItsReason) {
  EXPECT_EQ(filter_columns(fix_with(true, 2.5, 3)), "1,2.5000,");
  EXPECT_EQ(filter_columns(fix_with(false, 99.0, 3)), "0,99.0000,");
  EXPECT_EQ(filter_columns(fix_with(true, 0.0, 0)), "1,,filter restarted");
  GnssRow withheld = fix_with(false, 0.0, 0);
  withheld.withheld = true;
  EXPECT_EQ(filter_columns(withheld), "0,,withheld");
  GnssRow none;
  none.fix.reason = "3 satellites, needed 4";
  EXPECT_EQ(filter_columns(none), "0,,3 satellites; needed 4");
}

/// A turn about one axis of the frame and a shift along the same one: the shift is then that of SE(3)'s logarithm too.
struct Screw {
  Eigen::Index axis;
  double turns_rad, shifts_m;
};
/// Where a thing is put that truly is at `truth`, if the truth is the screw further on: `truth` times its inverse.
Pose before(const Pose& truth, const Screw& screw) {
  const Eigen::Vector3d along = Eigen::Vector3d::Unit(screw.axis);
  return {truth.R * Eigen::AngleAxisd(-screw.turns_rad, along), truth.p - truth.R * (screw.shifts_m * along)};
}
/// Of [turned; moved]: turn_sigma_rad and shift_sigma_m along the axis, correlated; five times as much, and
/// uncorrelated, along the others.
Matrix6d covariance_of(Eigen::Index axis, double turn_sigma_rad, double shift_sigma_m, double correlation) {
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(5.0 * turn_sigma_rad), Eigen::Vector3d::Constant(5.0 * shift_sigma_m);
  sigma[axis] = turn_sigma_rad;
  sigma[3 + axis] = shift_sigma_m;
  Matrix6d P = sigma.cwiseAbs2().asDiagonal();
  P(axis, 3 + axis) = P(3 + axis, axis) = correlation * turn_sigma_rad * shift_sigma_m;
  return P;
}

constexpr double kTurnSigma_deg = 0.5, kShiftSigma_m = 0.2, kCorrelation = 0.8;

/// The sensor looks north. Keyframe and step are off by so many sigma of turn and of shift.
KeyframeRow screwed(Eigen::Index axis, double turns, double shifts, double step_turns, double step_shifts) {
  const double turn_rad = kTurnSigma_deg * kDegree;
  KeyframeRow row;
  row.X_WL_true = {rotation_from({90.0 * kDegree, 0.0, 0.0}), {100.0, -50.0, 2.0}};
  row.X_WL_prior = row.X_WL_true;
  row.status = lidar::RegistrationStatus::kConverged;
  row.X_WL_registered = before(row.X_WL_true, {axis, turns * turn_rad, shifts * kShiftSigma_m});
  row.covariance = covariance_of(axis, turn_rad, kShiftSigma_m, kCorrelation);
  row.X_LL_true = {rotation_from({0.3, -0.1, 0.2}), {2.0, 0.5, -0.1}};
  row.placed.emplace();
  row.placed->X_TS = before(row.X_LL_true, {axis, step_turns * turn_rad, step_shifts * kShiftSigma_m});
  row.placed->covariance = row.covariance;
  row.alone = row.placed;
  return row;
}

// Of u sigma of turn and v sigma of shift with correlation r the normalized square is (u^2 - 2 r u v + v^2) / (1 -
// r^2); with r = 0.8 that is 1.8 / 0.36 of (2, 1), 8.2 / 0.36 of (2, -1) and 5.2 / 0.36 of (1, 3). An order of turn and
// shift that is another, or axes that are W's, would give other numbers.
TEST(EpochFiles, TheNormalizedSquareOfAKeyframeAndItsStepIsThatOfItsCovariance) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    auto of = keyframe_columns(screwed(axis, 2.0, 1.0, 2.0, -1.0));
    EXPECT_EQ(of["nees"], "5.000") << axis;
    EXPECT_EQ(of["step_nees"], "22.778") << axis;
    EXPECT_EQ(of["step_error_m"], "0.2000") << axis;
    EXPECT_EQ(of["step_error_deg"], "1.0000") << axis;
    of = keyframe_columns(screwed(axis, 2.0, -1.0, 1.0, 3.0));
    EXPECT_EQ(of["nees"], "22.778") << axis;
    EXPECT_EQ(of["step_nees"], "14.444") << axis;
    EXPECT_EQ(of["step_error_m"], "0.6000") << axis;
    EXPECT_EQ(of["step_error_deg"], "0.5000") << axis;
  }
}

// Turns are about the sensor's axes, registered less true: a truth that is a degree further on is a degree less. Of the
// sensor that looks north the first axis is north, the second west.
TEST(EpochFiles, AKeyframesAttitudeErrorIsAboutTheSensorsAxes) {
  const char* const errors[3] = {"error_roll_deg", "error_pitch_deg", "error_yaw_deg"};
  const char* const turn_sigmas[3] = {"sigma_roll_deg", "sigma_pitch_deg", "sigma_yaw_deg"};
  const char* const shift_sigmas[3] = {"sigma_n_m", "sigma_e_m", "sigma_u_m"};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    auto of = keyframe_columns(screwed(axis, 2.0, 1.0, 0.0, 0.0));
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double half_a_digit = 0.5e-4;
      EXPECT_NEAR(std::stod(of[errors[k]]), k == axis ? -1.0 : 0.0, half_a_digit) << axis;
      EXPECT_EQ(of[turn_sigmas[k]], k == axis ? "0.5000" : "2.5000") << axis;
      EXPECT_EQ(of[shift_sigmas[k]], k == axis ? "0.2000" : "1.0000") << axis;
    }
    EXPECT_EQ(of["registered_error_m"], "0.2000") << axis;
    EXPECT_EQ(of["prior_error_m"], "0.0000") << axis;
  }
}

// The first 28 stand where they stood on 2026-11-29, for those who count columns.
TEST(EpochFiles, NewColumnsOfAKeyframeAreTheLast) {
  const std::vector<std::string> names = cells(kKeyframeColumns);
  const std::vector<std::string> older = cells(
      "t_s,points,true_x_m,true_y_m,true_z_m,prior_error_m,prior_error_up_m,registered_error_m,registered_error_up_m,"
      "status,iterations,rms_m,error_roll_deg,error_pitch_deg,error_yaw_deg,sigma_e_m,sigma_n_m,sigma_u_m,"
      "sigma_roll_deg,sigma_pitch_deg,sigma_yaw_deg,nees,step_error_m,step_error_deg,step_nees,overlap,"
      "open_directions,map_status");
  ASSERT_EQ(names.size(), 44U);
  EXPECT_EQ(std::vector<std::string>(names.begin(), names.begin() + 28), older);
}

// The step has one error and the alignment another. Of (2, -1) sigma with correlation 0.8 the square is 8.2 / 0.36, of
// (1, 3) it is 5.2 / 0.36, as above. The registered pose is half as sure as both.
TEST(EpochFiles, TheAlignmentAloneHasItsOwnErrorSigmasAndSquare) {
  const char* const turns[3] = {"align_error_roll_deg", "align_error_pitch_deg", "align_error_yaw_deg"};
  const char* const shifts[3] = {"align_error_x_m", "align_error_y_m", "align_error_z_m"};
  const char* const turn_sigmas[3] = {"align_sigma_roll_deg", "align_sigma_pitch_deg", "align_sigma_yaw_deg"};
  const char* const shift_sigmas[3] = {"align_sigma_x_m", "align_sigma_y_m", "align_sigma_z_m"};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    KeyframeRow row = screwed(axis, 0.0, 0.0, 1.0, 3.0);
    row.alone->X_TS = before(row.X_LL_true, {axis, 2.0 * kTurnSigma_deg * kDegree, -1.0 * kShiftSigma_m});
    row.covariance *= 4.0;
    auto of = keyframe_columns(row);
    EXPECT_EQ(of["align_nees"], "22.778") << axis;
    EXPECT_EQ(of["step_nees"], "14.444") << axis;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double half_a_digit = 0.5e-4;
      EXPECT_NEAR(std::stod(of[turns[k]]), k == axis ? -1.0 : 0.0, half_a_digit) << axis;
      EXPECT_NEAR(std::stod(of[shifts[k]]), k == axis ? 0.2 : 0.0, half_a_digit) << axis;
      EXPECT_EQ(of[turn_sigmas[k]], k == axis ? "0.5000" : "2.5000") << axis;
      EXPECT_EQ(of[shift_sigmas[k]], k == axis ? "0.2000" : "1.0000") << axis;
    }
    // To the last bit: turned about x, y, z, moved along x, y, z, row by row.
    const std::vector<double> alone = numbers_in(of["align_covariance"]), fused = numbers_in(of["covariance"]);
    ASSERT_EQ(alone.size(), 21U) << of["align_covariance"];
    ASSERT_EQ(fused.size(), 21U) << of["covariance"];
    std::size_t at = 0;
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = i; j < 6; ++j, ++at) {
        EXPECT_EQ(alone[at], row.alone->covariance(i, j)) << axis << ": " << i << ", " << j;
        EXPECT_EQ(fused[at], row.covariance(i, j)) << axis << ": " << i << ", " << j;
      }
  }
}

TEST(EpochFiles, OpenDirectionsAreListed) {
  KeyframeRow row = screwed(0, 0.0, 0.0, 0.0, 0.0);
  row.open = std::vector<Vector6d>{Vector6d::Unit(3), (Vector6d() << 0.0, -0.125, 0.0, 0.0, 0.0, 0.0625).finished()};
  auto of = keyframe_columns(row);
  EXPECT_EQ(of["open_directions"], "2");
  EXPECT_EQ(of["open_vectors"], "0 0 0 1 0 0;0 -0.125 0 0 0 0.0625");
}

TEST(EpochFiles, WhatTheMethodSaysOfAKeyframeStandsInItsColumns) {
  KeyframeRow row = screwed(2, 1.0, 1.0, 1.0, 1.0);
  row.overlap = 0.8125;
  row.open.emplace(2, Vector6d::Unit(0));
  row.map_status = lidar::RegistrationStatus::kTooLittleOverlap;
  auto of = keyframe_columns(row);
  EXPECT_EQ(of["status"], "converged");
  EXPECT_EQ(of["overlap"], "0.8125");
  EXPECT_EQ(of["open_directions"], "2");
  EXPECT_EQ(of["map_status"], "too_little_overlap");
  row.open->clear();
  of = keyframe_columns(row);
  EXPECT_EQ(of["open_directions"], "0") << "none are open, which is not that nobody says";
  EXPECT_EQ(of["open_vectors"], "");
}

TEST(EpochFiles, WhatNobodyKnowsOfAKeyframeIsEmpty) {
  KeyframeRow row = screwed(0, 2.0, 1.0, 2.0, -1.0);
  auto of = keyframe_columns(row, false);
  for (const char* column : {"registered_error_m", "registered_error_up_m", "error_roll_deg", "error_pitch_deg",
                             "error_yaw_deg", "sigma_e_m", "sigma_yaw_deg", "nees", "covariance"})
    EXPECT_EQ(of[column], "") << column << ", though nothing registers";
  row = screwed(0, 2.0, 1.0, 2.0, -1.0);
  row.covariance.setConstant(kNaN);
  row.placed.reset();
  row.alone.reset();
  of = keyframe_columns(row);
  EXPECT_EQ(of["error_roll_deg"], "-1.0000");
  for (const char* column :
       {"sigma_roll_deg", "sigma_n_m", "nees", "step_error_m", "step_error_deg", "step_nees", "overlap",
        "open_directions", "map_status", "align_error_roll_deg", "align_error_x_m", "align_sigma_yaw_deg",
        "align_sigma_z_m", "align_nees", "align_covariance", "covariance", "open_vectors"})
    EXPECT_EQ(of[column], "") << column;
}

}  // namespace
}  // namespace canyon::mission
