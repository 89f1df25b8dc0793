#include "canyon/gnss/solver/reported_covariance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "canyon/core/check.h"
#include "canyon/core/units.h"
#include "canyon/gnss/solver/gauss_newton.h"
#include "canyon/gnss/solver/receiver_clocks.h"

namespace canyon::gnss {
namespace {

constexpr double kUnknownCn0Dbhz = 40.0;  // between a clear sky's and what is lost

Eigen::MatrixXd spread(const RangeEvidence& e, std::span<const double> sigma_m) {
  CANYON_CHECK(static_cast<Eigen::Index>(sigma_m.size()) == e.B.cols(), sigma_m.size(), " sigmas, ", e.B.cols(),
               " ranges");
  const Eigen::Map<const Eigen::VectorXd> sigma(sigma_m.data(), static_cast<Eigen::Index>(sigma_m.size()));
  const Eigen::MatrixXd scaled = e.B * sigma.asDiagonal();
  return e.predicted + scaled * scaled.transpose();
}

class Geometry final : public RangeErrorReport {
 public:
  std::vector<double> sigma_m(const RangeEvidence& e) const override { return e.assumed_m; }
  bool as_assumed() const override { return true; }
};

class ResidualInflated final : public RangeErrorReport {
 public:
  explicit ResidualInflated(const RangeErrorParameters& p) : p_(p) {}
  std::vector<double> sigma_m(const RangeEvidence& e) const override {
    std::vector<double> out = e.assumed_m;
    if (e.z.size() == 0) return out;
    const double squares = e.z.dot(spread(e, out).ldlt().solve(e.z));
    const double factor = std::sqrt(std::max(1.0, squares / static_cast<double>(e.z.size())));
    for (double& s : out) s *= factor;
    return out;
  }
  double correlation_s() const override { return p_.correlation_s; }

 private:
  RangeErrorParameters p_;
};

/// Kuusniemi, Wieser, Lachapelle & Takala (2007), who give a and b for either environment; the form of the variance is
/// SIGMA-epsilon (Hartinger & Brunner 1999).
class Environment final : public RangeErrorReport {
 public:
  Environment(const EnvironmentParameters& p, const RangeErrorParameters& time) : p_(p), time_(time) {}

  std::vector<double> sigma_m(const RangeEvidence& e) const override {
    const std::array<std::vector<double>, 3> by{e.assumed_m, degraded(e, p_.light_a_m2, p_.light_b_m2_hz),
                                                degraded(e, p_.heavy_a_m2, p_.heavy_b_m2_hz)};
    std::array<double, 3> weight{};
    double best = -1e300, sum = 0.0;
    for (std::size_t i = 0; i < by.size(); ++i) best = std::max(best, weight[i] = log_likelihood(e, by[i]));
    for (double& w : weight) sum += w = std::exp(w - best);
    std::vector<double> out(e.assumed_m.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
      double variance = 0.0;
      for (std::size_t i = 0; i < by.size(); ++i) variance += weight[i] / sum * by[i][k] * by[i][k];
      out[k] = std::sqrt(variance);
    }
    return out;
  }
  double correlation_s() const override { return time_.correlation_s; }

 private:
  /// Never better than what the receiver assumes.
  static std::vector<double> degraded(const RangeEvidence& e, double a_m2, double b_m2_hz) {
    std::vector<double> out;
    for (std::size_t k = 0; k < e.assumed_m.size(); ++k) {
      const RangeSignal& s = e.signals[k];
      const double cn0_dbhz = std::isnan(s.cn0_dbhz) ? kUnknownCn0Dbhz : s.cn0_dbhz;
      const double sigma_m = std::sqrt(a_m2 + b_m2_hz * std::pow(10.0, -0.1 * cn0_dbhz));
      out.push_back(std::max(e.assumed_m[k], s.code_factor * sigma_m));
    }
    return out;
  }

  EnvironmentParameters p_;
  RangeErrorParameters time_;
};

constexpr ModelRow<MakeRangeErrorReport> kReports[] = {
    {"geometry",
     [](const ModelParameters&) -> std::unique_ptr<RangeErrorReport> { return std::make_unique<Geometry>(); },
     "assumed 1-sigmas through the geometry"},
    {"residual_inflated",
     [](const ModelParameters& own) -> std::unique_ptr<RangeErrorReport> {
       return std::make_unique<ResidualInflated>(own.get<RangeErrorParameters>());
     },
     "the same, inflated where residuals, of excluded ranges too, are larger than assumed",
     parameters_of<RangeErrorParameters>},
    {"environment",
     [](const ModelParameters& own) -> std::unique_ptr<RangeErrorReport> {
       return std::make_unique<Environment>(own.get<EnvironmentParameters>(), own.get<RangeErrorParameters>());
     },
     "by C/N0 in an open, lightly or heavily degraded environment, which the residuals tell",
     [](ModelParameters& section) {
       section.add<RangeErrorParameters>();
       section.add<EnvironmentParameters>();
     }},
};

/// Design of a solved epoch: position, one column per solved clock, and the shared error if there is one.
struct Design {
  Eigen::MatrixXd H;
  std::vector<bool> known;  ///< false: no clock of that range is solved, its row is 0
  bool shared = false;
};

Design design_of(std::span<const RangeMeasurement> ranges, const PositionSolution& solution) {
  std::vector<GnssSystem> solved;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (solution.used[i]) solved.push_back(ranges[i].system);
  const bool clocks = std::isfinite(solution.clock_m);
  const ReceiverClocks order = clocks ? ReceiverClocks(solved) : ReceiverClocks();
  Design d;
  for (const auto& r : ranges) d.shared = d.shared || r.shared_m != 0.0;
  const auto columns = 3 + static_cast<Eigen::Index>(order.size()) + (d.shared ? 1 : 0);
  d.H = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(ranges.size()), columns);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto& systems = order.systems();
    const bool known =
        !clocks || std::find(systems.begin(), systems.end(), clock_system(ranges[i].system)) != systems.end();
    d.known.push_back(known);
    if (!known) continue;
    d.H.block<1, 3>(row, 0) = -line_of_sight(ranges[i].p_E, solution.p_E).line.transpose();
    if (clocks) d.H(row, 3 + static_cast<Eigen::Index>(order.index(ranges[i].system))) = 1.0;
    if (d.shared) d.H(row, columns - 1) = ranges[i].shared_m;
  }
  return d;
}

}  // namespace

void visit(FieldVisitor& f, RangeErrorParameters& c) {
  f.number("error_correlation_s", c.correlation_s, {0.0, 3600.0},
           "residual_inflated, environment: how long a range's error lasts; a filter's covariance does not average it "
           "away sooner");
}

void visit(FieldVisitor& f, EnvironmentParameters& c) {
  f.number("light_variance_m2", c.light_a_m2, {0.0, 1e6},
           "environment: a of the variance a + b 10^(-C/N0 / 10) of a range where signals are lightly degraded");
  f.number("light_variance_m2_hz", c.light_b_m2_hz, {0.0, 1e9}, "environment: b of it");
  f.number("heavy_variance_m2", c.heavy_a_m2, {0.0, 1e6}, "environment: a where they are heavily degraded");
  f.number("heavy_variance_m2_hz", c.heavy_b_m2_hz, {0.0, 1e9}, "environment: b of it");
}

ModelTable<MakeRangeErrorReport> reported_covariances() {
  return kReports;
}

double log_likelihood(const RangeEvidence& e, std::span<const double> sigma_m) {
  if (e.z.size() == 0) return 0.0;
  const Eigen::LDLT<Eigen::MatrixXd> factor(spread(e, sigma_m));
  return -0.5 * (e.z.dot(factor.solve(e.z)) + factor.vectorD().array().max(1e-300).log().sum());
}

RangeEvidence evidence_of(std::span<const RangeMeasurement> ranges, std::span<const RangeSignal> signals,
                          const PositionSolution& solution) {
  CANYON_CHECK(solution.ok && ranges.size() == signals.size() && ranges.size() == solution.used.size(), ranges.size(),
               " ranges, ", signals.size(), " signals, ", solution.used.size(), " solved");
  RangeEvidence out;
  for (const auto& r : ranges) out.assumed_m.push_back(r.sigma_m);
  out.signals.assign(signals.begin(), signals.end());
  const Design d = design_of(ranges, solution);
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (d.known[i]) rows.push_back(static_cast<Eigen::Index>(i));
  const Eigen::MatrixXd H = d.H(rows, Eigen::all);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(H);
  const Eigen::Index n = H.rows(), left = n - qr.rank();
  out.B = Eigen::MatrixXd::Zero(left, static_cast<Eigen::Index>(ranges.size()));
  out.z = Eigen::VectorXd::Zero(left);
  out.predicted = Eigen::MatrixXd::Zero(left, left);
  if (left == 0) return out;
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd residual(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    out.B.col(rows[static_cast<std::size_t>(k)]) = Q.rightCols(left).row(k).transpose();
    residual[k] = solution.residuals_m[static_cast<std::size_t>(rows[static_cast<std::size_t>(k)])];
  }
  out.z = Q.rightCols(left).transpose() * residual;
  return out;
}

Eigen::MatrixXd spread_of_fit(std::span<const RangeMeasurement> ranges, std::span<const double> sigma_m,
                              const PositionSolution& solution) {
  const Design d = design_of(ranges, solution);
  const Eigen::Index columns = d.H.cols();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(d.H.rows() + (d.shared ? 1 : 0), columns);
  Eigen::VectorXd ratio = Eigen::VectorXd::Ones(A.rows());  // of the sigma said to the one assumed
  for (Eigen::Index i = 0; i < d.H.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!solution.used[k]) continue;
    A.row(i) = d.H.row(i) / ranges[k].sigma_m;
    ratio[i] = sigma_m[k] / ranges[k].sigma_m;
  }
  if (d.shared) A(A.rows() - 1, columns - 1) = 1.0;
  return A.completeOrthogonalDecomposition().pseudoInverse().topRows<3>() * ratio.asDiagonal();
}

Eigen::Matrix3d covariance_of_fit(std::span<const RangeMeasurement> ranges, std::span<const double> sigma_m,
                                  const PositionSolution& solution) {
  const Eigen::MatrixXd spread_m = spread_of_fit(ranges, sigma_m, solution);
  return spread_m * spread_m.transpose();
}

}  // namespace canyon::gnss
