#include "canyon/lidar/map_quality/trajectory_error.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "canyon/core/math/median.h"
#include "canyon/core/units.h"

namespace canyon::lidar {
namespace {

constexpr ModelRow<TrajectoryAlignment> kAlignments[] = {
    {"none", TrajectoryAlignment::kNone, "as they are"},
    {"yaw", TrajectoryAlignment::kYaw, "turned about the vertical, and shifted"},
    {"se3", TrajectoryAlignment::kSe3, "turned and shifted"},
};

struct PosePair {
  GpsTime t;
  Pose truth, estimate;
};

std::vector<PosePair> pairs_of(const Trajectory& truth, const Trajectory& estimate) {
  std::vector<PosePair> out;
  for (const StampedPose& pose : estimate.poses())
    if (const auto true_pose = truth.at(pose.t)) out.push_back({pose.t, *true_pose, pose.X_WB});
  return out;
}

struct Centred {
  Eigen::Vector3d truth = Eigen::Vector3d::Zero(), estimate = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< sum of truth * estimate^T about the means
};

Centred centred(const std::vector<PosePair>& pairs) {
  Centred out;
  for (const PosePair& pair : pairs) {
    out.truth += pair.truth.p;
    out.estimate += pair.estimate.p;
  }
  out.truth /= static_cast<double>(pairs.size());
  out.estimate /= static_cast<double>(pairs.size());
  for (const PosePair& pair : pairs)
    out.covariance += (pair.truth.p - out.truth) * (pair.estimate.p - out.estimate).transpose();
  return out;
}

/// Least squares over the positions (Umeyama, IEEE Trans. PAMI 13 (1991) 376, without scale).
Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, 1);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs[2] = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// The same with one angle free.
Eigen::Matrix3d best_yaw(const Eigen::Matrix3d& c) {
  const double sine = c(1, 0) - c(0, 1), cosine = c(0, 0) + c(1, 1);
  const double yaw = std::hypot(sine, cosine) > 0.0 ? std::atan2(sine, cosine) : 0.0;
  return rotation_from({.yaw_rad = yaw}).toRotationMatrix();
}

/// Of the true positions' largest spread.
Eigen::Vector3d longest_axis(const std::vector<PosePair>& pairs, const Eigen::Vector3d& mean) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) spread += (pair.truth.p - mean) * (pair.truth.p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
}

/// Whether the turn about an axis is: all poses count as one, so that as many more of the same drive, or of the same
/// noise, make it no surer. Exact positions leave nothing of errors, and determine it by any distance from the axis
/// that is more than rounding.
bool turn_is_determined(const std::vector<PosePair>& pairs, const Pose& X, const Eigen::Vector3d& mean,
                        const Eigen::Vector3d& axis) {
  constexpr double kSurest_rad = 1.0 * kDegree, kRounding = 1e-12;
  double away2 = 0.0, from_axis2 = 0.0, errors2 = 0.0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d from_mean = pair.truth.p - mean;
    away2 += from_mean.squaredNorm();
    from_axis2 += axis.cross(from_mean).squaredNorm();
    errors2 += 0.5 * axis.cross(X * pair.estimate.p - pair.truth.p).squaredNorm();
  }
  return std::sqrt(from_axis2) > kRounding * std::sqrt(away2) &&
         std::sqrt(errors2) < kSurest_rad * std::sqrt(from_axis2);
}

Pose aligned(const std::vector<PosePair>& pairs, TrajectoryAlignment alignment, bool& determined) {
  if (alignment == TrajectoryAlignment::kNone || pairs.empty()) return {};
  const Centred c = centred(pairs);
  const bool yaw = alignment == TrajectoryAlignment::kYaw;
  const Eigen::Matrix3d R = yaw ? best_yaw(c.covariance) : best_rotation(c.covariance);
  const Pose out{Eigen::Quaterniond(R), c.truth - R * c.estimate};
  determined = turn_is_determined(pairs, out, c.truth, yaw ? Eigen::Vector3d::UnitZ() : longest_axis(pairs, c.truth));
  return out;
}

double angle_deg(const Eigen::Quaterniond& q) {
  return so3_log(q).norm() / kDegree;
}

/// `along`: way or time at each pose, growing.
RelativeErrors relative_errors(const std::vector<PosePair>& pairs, const std::vector<double>& along, double step,
                               std::string over) {
  RelativeErrors out;
  out.over = std::move(over);
  const double rounding = 1e-9 * step;
  double squares_m2 = 0.0, squares_deg2 = 0.0;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && along[j] - along[i] < step - rounding) ++j;
    if (j == pairs.size()) break;
    if (along[j] - along[i] > 2.0 * step - rounding) continue;  // poses too far apart: another stretch
    const Pose truth = pairs[i].truth.inverse() * pairs[j].truth;
    const Pose error = truth.inverse() * (pairs[i].estimate.inverse() * pairs[j].estimate);
    squares_m2 += error.p.squaredNorm();
    squares_deg2 += std::pow(angle_deg(error.R), 2);
    ++out.pairs;
  }
  if (out.pairs == 0) return out;
  out.translation_rms_m = std::sqrt(squares_m2 / static_cast<double>(out.pairs));
  out.rotation_rms_deg = std::sqrt(squares_deg2 / static_cast<double>(out.pairs));
  return out;
}

void fill_relative(const std::vector<PosePair>& pairs, TrajectoryErrors& out) {
  std::vector<double> way_m, time_s;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    way_m.push_back(i == 0 ? 0.0 : way_m.back() + (pairs[i].truth.p - pairs[i - 1].truth.p).norm());
    time_s.push_back(pairs[i].t - pairs.front().t);
  }
  for (const int metres : {1, 10, 100})
    out.relative.push_back(relative_errors(pairs, way_m, metres, std::to_string(metres) + " m"));
  for (const int seconds : {1, 10})
    out.relative.push_back(relative_errors(pairs, time_s, seconds, std::to_string(seconds) + " s"));
}

}  // namespace

ModelTable<TrajectoryAlignment> trajectory_alignments() {
  return kAlignments;
}

TrajectoryErrors trajectory_errors(const Trajectory& truth, const Trajectory& estimate, TrajectoryAlignment alignment) {
  TrajectoryErrors out;
  const std::vector<PosePair> pairs = pairs_of(truth, estimate);
  out.poses = static_cast<std::int64_t>(pairs.size());
  fill_relative(pairs, out);
  if (pairs.empty()) return out;
  out.X_true_estimated = aligned(pairs, alignment, out.alignment_determined);
  std::vector<double> errors_m;
  double squares_m2 = 0.0, sum_m = 0.0, squares_deg2 = 0.0;
  for (const PosePair& pair : pairs) {
    const Pose error = pair.truth.inverse() * (out.X_true_estimated * pair.estimate);
    errors_m.push_back(error.p.norm());
    sum_m += errors_m.back();
    squares_m2 += errors_m.back() * errors_m.back();
    squares_deg2 += std::pow(angle_deg(error.R), 2);
  }
  const auto n = static_cast<double>(pairs.size());
  out.ate_rms_m = std::sqrt(squares_m2 / n);
  out.ate_mean_m = sum_m / n;
  out.ate_median_m = median(errors_m);
  out.ate_max_m = *std::max_element(errors_m.begin(), errors_m.end());
  out.rotation_rms_deg = std::sqrt(squares_deg2 / n);
  return out;
}

}  // namespace canyon::lidar
