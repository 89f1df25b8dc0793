#include "canyon/lidar/registration/cloud_pair.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "canyon/lidar/registration/prepared_cloud.h"

namespace canyon::lidar {
namespace {

constexpr double kFineTo_m = 1e4;

double ms_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

/// What marks a missing return, in the cloud's own coordinates.
bool is_missing(const Eigen::Vector3d& p) {
  return p == Eigen::Vector3d::Zero();
}

/// The median along each axis: a few points that are far off do not move it. Of no points the origin.
Eigen::Vector3d middle_of(const CloudPlaces& cloud) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (Eigen::Index a = 0; a < 3; ++a) {
    std::vector<double> along;
    along.reserve(cloud.points.size());
    for (const Eigen::Vector3d& p : cloud.points) {
      if (p.allFinite() && !is_missing(p)) along.push_back(p[a]);
    }
    if (along.empty()) return Eigen::Vector3d::Zero();
    const auto half = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), half, along.end());
    middle[a] = *half;
  }
  return middle;
}

/// The middle in whole metres; near the origin the origin, so that a sensor's own cloud stays as it is.
Eigen::Vector3d origin_for(const Eigen::Vector3d& middle) {
  const Eigen::Vector3d whole = middle.array().round();
  return whole.norm() < 1000.0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : whole;
}

std::vector<Eigen::Vector3f> about(const CloudPlaces& cloud, const Eigen::Vector3d& origin) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(cloud.points.size());
  for (const Eigen::Vector3d& p : cloud.points) {
    if (!is_missing(p)) points.push_back((p - origin).cast<float>());
  }
  return points;
}

/// Adjoint of a shift: xi in a frame whose origin stands at `origin`, of xi in the one that this is said in.
Matrix6d shifted(const Eigen::Vector3d& origin) {
  Matrix6d adjoint = Matrix6d::Identity();
  adjoint.bottomLeftCorner<3, 3>() = -skew(origin);
  return adjoint;
}

}  // namespace

CloudPair register_pair(const Registration& method, const CloudPlaces& source, const CloudPlaces& target,
                        const PosePrior& prior) {
  CloudPair out;
  const auto begin = std::chrono::steady_clock::now();
  const Eigen::Vector3d middle = middle_of(source);
  const Pose from_source{Eigen::Quaterniond::Identity(), origin_for(middle)};
  const Pose from_target{Eigen::Quaterniond::Identity(), origin_for(middle_of(target))};
  const auto s = method.prepare(about(source, from_source.p));
  const Registration::Placed placed{method.prepare(about(target, from_target.p)), Pose{}};
  out.preprocess_ms = ms_since(begin);
  out.source_points = s->points.size();
  out.target_points = placed.cloud->points.size();
  const auto aligning = std::chrono::steady_clock::now();
  const Matrix6d from_middle = shifted(from_source.p - middle), back = shifted(-from_source.p);
  PosePrior about_origins{from_target.inverse() * prior.X_TS * from_source, prior.covariance};
  if (prior.covariance.allFinite()) about_origins.covariance = from_middle * prior.covariance * from_middle.transpose();
  out.result = method.align_with_prior(*s, {&placed, 1}, about_origins);
  out.align_ms = ms_since(aligning);
  out.result.X_TS = from_target * out.result.X_TS * from_source.inverse();
  if (out.result.covariance.allFinite()) out.result.covariance = back * out.result.covariance * back.transpose();
  for (Vector6d& v : out.result.open) v = back * v;
  if (out.result.surfaces) {
    RegistrationResult::Surfaces& alone = *out.result.surfaces;
    alone = {from_target * alone.X_TS * from_source.inverse(), back * alone.covariance * back.transpose()};
  }
  return out;
}

std::string cloud_doubt(const std::string& path, const CloudPlaces& cloud) {
  std::vector<std::string> doubts;
  const auto& points = cloud.points;
  const auto not_finite = std::count_if(points.begin(), points.end(), [](const auto& p) { return !p.allFinite(); });
  if (not_finite > 0)
    doubts.push_back(std::to_string(not_finite) + " of " + std::to_string(points.size()) +
                     " points are not finite and left out");
  const auto is_coarse = [](const Eigen::Vector3d& p) {
    return p.allFinite() && p.cwiseAbs().maxCoeff() > kFineTo_m && p.cwiseAbs().maxCoeff() < 1e8;
  };
  if (cloud.single_precision && std::any_of(points.begin(), points.end(), is_coarse))
    doubts.emplace_back("coordinates in single precision beyond 10 km are no finer than 1 mm");
  std::string out;
  for (const std::string& doubt : doubts) out += (out.empty() ? path + ": " : "; ") + doubt;
  return out;
}

}  // namespace canyon::lidar
