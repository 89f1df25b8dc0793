#include "canyon/gnss/solver/gauss_newton.h"

#include <cmath>
#include <cstdio>

#include <Eigen/QR>

#include "canyon/core/check.h"
#include "canyon/core/earth/earth.h"
#include "canyon/core/units.h"
#include "canyon/gnss/satellites/transmission.h"
#include "canyon/gnss/solver/receiver_clocks.h"

namespace canyon::gnss {
namespace {

constexpr int kMaxIterations = 30;
constexpr double kConvergedM = 1e-6;

std::string singular_reason(double gdop, double max_gdop) {
  char text[128];
  if (std::isfinite(gdop))
    std::snprintf(text, sizeof text, "satellite geometry is singular: GDOP %.3g exceeds %g", gdop, max_gdop);
  else
    std::snprintf(text, sizeof text, "satellite geometry is singular: GDOP is infinite");
  return text;
}

std::string too_few_reason(Eigen::Index n, std::size_t systems, Eigen::Index unknowns) {
  std::string out = std::to_string(n) + (n == 1 ? " satellite" : " satellites");
  if (systems > 1) out += " of " + std::to_string(systems) + " systems";
  return out + ", a fix needs " + std::to_string(unknowns);
}

/// The linear problem at a point: rows are ranges divided by their sigma, then the prior of the shared error. Columns:
/// position, clocks, shared error.
class Problem {
 public:
  Problem(std::span<const RangeMeasurement> ranges, bool clocks) : ranges_(ranges) {
    if (clocks) clocks_ = ReceiverClocks(ranges);
    for (const auto& r : ranges) {
      CANYON_CHECK(std::isfinite(r.range_m) && r.p_E.allFinite() && r.sigma_m > 0.0 && std::isfinite(r.sigma_m) &&
                       std::isfinite(r.shared_m),
                   "range_m = ", r.range_m, ", sigma_m = ", r.sigma_m, ", shared_m = ", r.shared_m);
      shared_ = shared_ || r.shared_m != 0.0;
      systems_.push_back(r.system);
    }
    state_ = Eigen::VectorXd::Zero(3 + clock_count() + (shared_ ? 1 : 0));
    A_ = Eigen::MatrixXd::Zero(range_count() + (shared_ ? 1 : 0), state_.size());
    b_ = Eigen::VectorXd::Zero(A_.rows());
    residuals_m_.resize(ranges.size());
    lines_.resize(ranges.size());
  }

  Eigen::Index range_count() const { return static_cast<Eigen::Index>(ranges_.size()); }
  Eigen::Index clock_count() const { return static_cast<Eigen::Index>(clocks_.size()); }
  Eigen::Index unknowns_without_prior() const { return 3 + clock_count(); }
  Eigen::VectorXd& state() { return state_; }
  const Eigen::MatrixXd& A() const { return A_; }
  const Eigen::VectorXd& b() const { return b_; }
  double sigma_m(Eigen::Index i) const { return ranges_[static_cast<std::size_t>(i)].sigma_m; }
  const std::vector<double>& residuals_m() const { return residuals_m_; }
  double shared() const { return shared_ ? state_[state_.size() - 1] : 0.0; }

  void linearise() {
    const Eigen::Vector3d p_E = state_.head<3>();
    const Eigen::Index last = state_.size() - 1;
    for (Eigen::Index i = 0; i < range_count(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const auto& r = ranges_[k];
      const LineOfSight sight = line_of_sight(r.p_E, p_E);
      lines_[k] = sight.line;
      double predicted_m = sight.range_m;
      A_.block<1, 3>(i, 0) = -sight.line.transpose() / r.sigma_m;
      if (clock_count() > 0) {
        const auto column = 3 + static_cast<Eigen::Index>(clocks_.index(r.system));
        A_(i, column) = 1.0 / r.sigma_m;
        predicted_m += state_[column];
      }
      if (shared_) {
        A_(i, last) = r.shared_m / r.sigma_m;
        predicted_m += r.shared_m * state_[last];
      }
      residuals_m_[k] = r.range_m - predicted_m;
      b_[i] = residuals_m_[k] / r.sigma_m;
    }
    if (shared_) {
      A_(range_count(), last) = 1.0;
      b_[range_count()] = -state_[last];
    }
  }

  Dop dop() const {
    const Eigen::Vector3d p_E = state_.head<3>();
    const Eigen::Matrix3d R = rotation_E_from_enu(geodetic_from_ecef(p_E));
    return clock_count() > 0 ? dilution_of_precision(lines_, systems_, R) : dilution_of_precision(lines_, R, false);
  }

 private:
  std::span<const RangeMeasurement> ranges_;
  ReceiverClocks clocks_;
  bool shared_ = false;
  std::vector<GnssSystem> systems_;
  Eigen::VectorXd state_, b_;
  Eigen::MatrixXd A_;
  std::vector<double> residuals_m_;
  std::vector<Eigen::Vector3d> lines_;
};

/// (A'A)^-1 from A = Q R P', without forming A'A; infinite where A is singular.
Eigen::MatrixXd inverse_normal(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr) {
  const Eigen::Index n = qr.cols();
  const Eigen::MatrixXd R_inverse =
      qr.matrixQR().topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd scaled = qr.colsPermutation() * R_inverse;
  return scaled * scaled.transpose();
}

/// Everything about the converged point that comes out of its linear problem.
void describe(Problem& problem, const Eigen::MatrixXd& covariance, RangeFit& out) {
  problem.linearise();
  out.p_E = problem.state().head<3>();
  for (Eigen::Index c = 0; c < problem.clock_count(); ++c) out.clock_m.push_back(problem.state()[3 + c]);
  out.shared = problem.shared();
  out.covariance_E = covariance.topLeftCorner<3, 3>();
  out.residuals_m = problem.residuals_m();
  out.statistic = problem.b().squaredNorm();
  out.range_gain = 0.0;
  for (Eigen::Index i = 0; i < problem.range_count(); ++i)
    out.range_gain += (covariance.topRows<3>() * problem.A().row(i).transpose()).norm() / problem.sigma_m(i);
  out.degrees_of_freedom = static_cast<int>(problem.range_count() - problem.unknowns_without_prior());
  for (Eigen::Index i = 0; i < problem.range_count(); ++i) {
    out.weighted.push_back(problem.b()[i]);
    out.redundancy.push_back(1.0 - problem.A().row(i) * covariance * problem.A().row(i).transpose());
  }
}

}  // namespace

LineOfSight line_of_sight(const Eigen::Vector3d& satellite_E, const Eigen::Vector3d& p_E) {
  double range_m = (satellite_E - p_E).norm();
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  for (int turn = 0; turn < 3; ++turn) {
    way = turned_by_earth(satellite_E, range_m / kSpeedOfLight) - p_E;
    range_m = way.norm();
  }
  return {range_m, way / range_m};
}

RangeFit fit_ranges(std::span<const RangeMeasurement> ranges, const Eigen::Vector3d& guess_E, bool clocks,
                    double max_gdop) {
  Problem problem(ranges, clocks);
  RangeFit out;
  const Eigen::Index needed = ranges.empty() && clocks ? 4 : problem.unknowns_without_prior();
  if (problem.range_count() < needed) {
    out.reason = too_few_reason(problem.range_count(), static_cast<std::size_t>(problem.clock_count()), needed);
    return out;
  }

  Eigen::VectorXd& x = problem.state();
  x.head<3>() = guess_E;
  bool converged = false;
  Eigen::MatrixXd covariance;
  while (!converged && out.iterations < kMaxIterations && x.allFinite()) {
    ++out.iterations;
    problem.linearise();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(problem.A());
    const Eigen::VectorXd dx = qr.solve(problem.b());
    x += dx;
    converged = dx.norm() < kConvergedM;
    if (converged) covariance = inverse_normal(qr);
  }

  if (x.allFinite()) {
    out.dop = problem.dop();
    if (!(out.dop.gdop <= max_gdop)) {
      out.reason = singular_reason(out.dop.gdop, max_gdop);
      return out;
    }
  }
  if (!converged) {
    out.reason = "the position does not converge in " + std::to_string(kMaxIterations) + " iterations";
    return out;
  }
  out.ok = true;
  describe(problem, covariance, out);
  return out;
}

}  // namespace canyon::gnss
