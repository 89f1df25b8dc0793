#include "gnss/solver/gauss_newton.h"

#include <cmath>
#include <cstdio>

#include <Eigen/SVD>

#include "core/check.h"
#include "core/earth.h"
#include "core/units.h"
#include "gnss/satellites/transmission.h"

namespace canyon::gnss {
namespace {

constexpr int kMaxIterations = 30;
constexpr double kConvergedM = 1e-6;

struct Linearised {
  std::vector<Eigen::Vector3d> lines;  // unit, receiver to satellite
  Eigen::VectorXd residuals_m;         // measured minus computed
};

Linearised linearise(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& p_E, double clock_m) {
  Linearised out;
  out.residuals_m.resize(static_cast<Eigen::Index>(ranges.size()));
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    double range_m = (ranges[i].p_E - p_E).norm();
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    for (int turn = 0; turn < 3; ++turn) {
      way = turned_by_earth(ranges[i].p_E, range_m / kSpeedOfLight) - p_E;
      range_m = way.norm();
    }
    out.lines.push_back(way / range_m);
    out.residuals_m[static_cast<Eigen::Index>(i)] = ranges[i].range_m - range_m - clock_m;
  }
  return out;
}

std::string singular_reason(double gdop, double max_gdop) {
  char text[128];
  if (std::isfinite(gdop))
    std::snprintf(text, sizeof text, "satellite geometry is singular: GDOP %.3g exceeds %g", gdop, max_gdop);
  else
    std::snprintf(text, sizeof text, "satellite geometry is singular: GDOP is infinite");
  return text;
}

}  // namespace

PositionSolution solve_ranges(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E, bool clock,
                              const PositionSolverParameters& p) {
  const Eigen::Index unknowns = clock ? 4 : 3;
  const auto n = static_cast<Eigen::Index>(ranges.size());
  PositionSolution out;
  if (n < unknowns) {
    out.reason =
        std::to_string(n) + (n == 1 ? " satellite" : " satellites") + ", a fix needs " + std::to_string(unknowns);
    return out;
  }
  Eigen::VectorXd weight(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& r = ranges[static_cast<std::size_t>(i)];
    CANYON_CHECK(std::isfinite(r.range_m) && r.p_E.allFinite() && r.sigma_m > 0.0, "range_m = ", r.range_m,
                 ", sigma_m = ", r.sigma_m);
    weight[i] = 1.0 / r.sigma_m;
  }

  Eigen::Vector3d p_E = guess_E;
  double clock_m = 0.0;
  bool converged = false;
  Eigen::MatrixXd covariance(unknowns, unknowns);
  Linearised now;
  while (!converged && out.iterations < kMaxIterations && p_E.allFinite()) {
    ++out.iterations;
    now = linearise(ranges, p_E, clock_m);
    Eigen::MatrixXd A(n, unknowns);
    for (Eigen::Index i = 0; i < n; ++i) {
      A.block<1, 3>(i, 0) = -now.lines[static_cast<std::size_t>(i)].transpose();
      if (clock) A(i, 3) = 1.0;
      A.row(i) *= weight[i];
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const Eigen::VectorXd dx = svd.solve(weight.cwiseProduct(now.residuals_m));
    p_E += dx.head<3>();
    if (clock) clock_m += dx[3];
    converged = dx.norm() < kConvergedM;
    const Eigen::MatrixXd scaled = svd.matrixV() * svd.singularValues().cwiseInverse().asDiagonal();
    covariance = scaled * scaled.transpose();
  }

  if (p_E.allFinite()) {
    out.dop = dilution_of_precision(now.lines, rotation_E_from_enu(geodetic_from_ecef(p_E)), clock);
    if (!(out.dop.gdop <= p.max_gdop)) {
      out.reason = singular_reason(out.dop.gdop, p.max_gdop);
      return out;
    }
  }
  if (!converged) {
    out.reason = "the position does not converge in " + std::to_string(kMaxIterations) + " iterations";
    return out;
  }
  out.ok = true;
  out.p_E = p_E;
  if (clock) out.clock_m = clock_m;
  out.covariance_E = covariance.topLeftCorner<3, 3>();
  now = linearise(ranges, p_E, clock_m);
  out.residuals_m.assign(now.residuals_m.data(), now.residuals_m.data() + n);
  return out;
}

}  // namespace canyon::gnss
