#include "canyon/gnss/solver/velocity.h"

#include <cmath>
#include <cstdio>
#include <numeric>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/math/singular_values.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/signal.h"
#include "canyon/gnss/solver/gauss_newton.h"

namespace canyon::gnss {
namespace {

/// The range rate is linear in the receiver's velocity: rate = (line . (u - v)) / stretch.
struct Linear {
  Eigen::Vector3d line;
  double of_satellite_m_s;  // line . u
  double stretch;
};

/// rho(t) = |R(tau) p_s(t - tau) - p_r(t)| with tau = rho / c, so rho' = line . (R v_s (1 - tau') + R' p_s tau' - v_r),
/// and tau' = rho' / c on both sides.
Linear linear(const RateMeasurement& m, const Eigen::Vector3d& p_E) {
  const LineOfSight sight = line_of_sight(m.p_E, p_E);
  const double travel_s = sight.range_m / kSpeedOfLight;
  const Eigen::Vector3d p = turned_by_earth(m.p_E, travel_s), v = turned_by_earth(m.v_E, travel_s);
  const Eigen::Vector3d turning = kGpsEarthRate * Eigen::Vector3d(p.y(), -p.x(), 0.0);
  return {sight.line, sight.line.dot(v), 1.0 + sight.line.dot(v - turning) / kSpeedOfLight};
}

struct Fit {
  Eigen::Vector4d x;
  Eigen::Matrix4d covariance;
  Eigen::VectorXd standardised;
};

Fit fit(const std::vector<Linear>& lines, std::span<const RateMeasurement> rates,
        const std::vector<std::size_t>& members) {
  const auto n = static_cast<Eigen::Index>(members.size());
  Eigen::MatrixXd A(n, 4);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = members[static_cast<std::size_t>(i)];
    const double weight = 1.0 / rates[k].sigma_m_s;
    A.block<1, 3>(i, 0) = -weight / lines[k].stretch * lines[k].line.transpose();
    A(i, 3) = weight;
    b[i] = weight * (rates[k].rate_m_s - lines[k].of_satellite_m_s / lines[k].stretch);
  }
  const SingularValues svd(A);
  Fit out;
  out.x = svd.solve(b, 1e-15);
  const Eigen::MatrixXd scaled = svd.V * svd.values.cwiseInverse().asDiagonal();
  out.covariance = scaled * scaled.transpose();
  const Eigen::VectorXd residual = b - A * out.x;
  out.standardised.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double redundancy = 1.0 - A.row(i) * out.covariance * A.row(i).transpose();
    out.standardised[i] = redundancy > 1e-6 ? residual[i] / std::sqrt(redundancy) : 0.0;
  }
  return out;
}

}  // namespace

double pseudorange_rate_m_s(double doppler_hz, double carrier_hz) {
  return -doppler_hz * kSpeedOfLight / carrier_hz;
}

double range_rate_m_s(const RateMeasurement& m, const Eigen::Vector3d& p_E, const Eigen::Vector3d& v_E) {
  const Linear l = linear(m, p_E);
  return (l.of_satellite_m_s - l.line.dot(v_E)) / l.stretch;
}

VelocitySolution solve_velocity(std::span<const RateMeasurement> rates, const Eigen::Vector3d& p_E,
                                const VelocityParameters& p) {
  VelocitySolution out;
  if (rates.size() < 4) {
    out.reason = std::to_string(rates.size()) + (rates.size() == 1 ? " Doppler" : " Dopplers") + ", a velocity needs 4";
    return out;
  }
  std::vector<Linear> lines;
  std::vector<Eigen::Vector3d> directions;
  for (const auto& r : rates) {
    CANYON_CHECK(std::isfinite(r.rate_m_s) && r.p_E.allFinite() && r.v_E.allFinite() && r.sigma_m_s > 0.0 &&
                     std::isfinite(r.sigma_m_s),
                 "rate_m_s = ", r.rate_m_s, ", sigma_m_s = ", r.sigma_m_s);
    lines.push_back(linear(r, p_E));
    directions.push_back(lines.back().line);
  }
  const Dop dop = dilution_of_precision(directions, rotation_E_from_enu(geodetic_from_ecef(p_E)), true);
  if (!(dop.gdop <= p.max_gdop)) {
    char text[128];
    std::snprintf(text, sizeof text, "satellite geometry is singular: GDOP %.3g exceeds %g", dop.gdop, p.max_gdop);
    out.reason = text;
    return out;
  }

  std::vector<std::size_t> members(rates.size());
  std::iota(members.begin(), members.end(), std::size_t{0});
  Fit solution = fit(lines, rates, members);
  while (p.outlier_sigmas > 0.0 && members.size() > 5) {
    Eigen::Index worst = 0;
    if (solution.standardised.cwiseAbs().maxCoeff(&worst) <= p.outlier_sigmas) break;
    members.erase(members.begin() + worst);
    solution = fit(lines, rates, members);
  }

  out.ok = true;
  out.v_E = solution.x.head<3>();
  out.clock_drift_m_s = solution.x[3];
  out.covariance_E = solution.covariance.topLeftCorner<3, 3>();
  out.used.assign(rates.size(), false);
  for (const std::size_t i : members) out.used[i] = true;
  for (std::size_t i = 0; i < rates.size(); ++i)
    out.residuals_m_s.push_back(rates[i].rate_m_s - range_rate_m_s(rates[i], p_E, out.v_E) - out.clock_drift_m_s);
  return out;
}

}  // namespace canyon::gnss
