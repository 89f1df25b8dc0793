#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/model_choice.h"
#include "canyon/gnss/solver/position_solver.h"

namespace canyon::gnss {

/// What is known of the signal of a range, beside the range.
struct RangeSignal {
  std::uint32_t entity = 0;  ///< the satellite, as SatelliteId::entity(): its errors last from epoch to epoch
  double cn0_dbhz = kNaN;    ///< NaN: not known
  double code_factor = 1.0;  ///< of the code's errors: 2 to 3 for an ionosphere-free combination
};

/// What an epoch shows of the errors e of its ranges: contrasts z = B e + error of a prediction, whose covariance is
/// `predicted`. Of one epoch by itself B is the parity of its geometry (Sturza 1988), in which nothing of position and
/// clocks is left, and `predicted` is 0; of a filter z are the innovations and B the identity.
struct RangeEvidence {
  Eigen::VectorXd z;
  Eigen::MatrixXd B, predicted;
  std::vector<double> assumed_m;  ///< 1-sigma by the receiver's weights, each > 0; parallel to the columns of B
  std::vector<RangeSignal> signals;
};

/// The errors of ranges as the receiver describes them when it says how good its fix is. The weights of the fix are
/// another matter: what is said here changes no position.
class RangeErrorReport {
 public:
  virtual ~RangeErrorReport() = default;
  /// 1-sigma of every range, parallel to evidence.assumed_m.
  virtual std::vector<double> sigma_m(const RangeEvidence& evidence) const = 0;
  /// Whether it is the assumed ones whatever the evidence, so that the fit's own covariance is what is reported.
  virtual bool as_assumed() const { return false; }
  /// How long an error lasts, s; a filter must not average it away sooner.
  virtual double correlation_s() const { return 0.0; }
};

/// Keys of all but `geometry`.
struct RangeErrorParameters {
  double correlation_s = 10.0;
};
void visit(FieldVisitor& f, RangeErrorParameters& c);

/// Keys of `environment`: variance = a + b 10^(-C/N0 / 10) of pseudoranges in light and in heavy degradation.
struct EnvironmentParameters {
  double light_a_m2 = 10.0, light_b_m2_hz = 22500.0;
  double heavy_a_m2 = 500.0, heavy_b_m2_hz = 1e6;
};
void visit(FieldVisitor& f, EnvironmentParameters& c);

/// Rows:
/// - geometry: the assumed sigmas through the geometry, and nothing else.
/// - residual_inflated: all assumed sigmas times the root of z' S^-1 z / degrees of freedom, or 1 if that is less (the
///   a-posteriori variance of unit weight), S by the assumed sigmas; excluded ranges count as evidence.
/// - environment: open sky (the assumed sigmas), a lightly or a heavily degraded environment, by what the epoch's
///   evidence makes of the three, equal before it; variances averaged over the three.
using MakeRangeErrorReport = std::unique_ptr<RangeErrorReport>(const ModelParameters& own);
ModelTable<MakeRangeErrorReport> reported_covariances();

/// Log-likelihood of the evidence if the ranges' errors have these sigmas.
double log_likelihood(const RangeEvidence& evidence, std::span<const double> sigma_m);

/// What ranges and their signals show at a solution of them. Ranges whose system's clock is not among the solved ones
/// tell nothing: their columns are 0.
RangeEvidence evidence_of(std::span<const RangeMeasurement> ranges, std::span<const RangeSignal> signals,
                          const PositionSolution& solution);

/// What an error of sigma_m of each range moves solution.p_E by, m in E: the fit's own gain times the sigmas, a column
/// for each range, 0 for those not used, and one more for the prior of a shared error where there is one.
Eigen::MatrixXd spread_of_fit(std::span<const RangeMeasurement> ranges, std::span<const double> sigma_m,
                              const PositionSolution& solution);

/// Covariance of solution.p_E, m^2 in E, if the ranges' errors are independent with sigma_m, whatever weights the
/// solution gave them: G diag(sigma^2) G' with the fit's own gain G. With the sigmas of the ranges themselves it is
/// solution.covariance_E.
Eigen::Matrix3d covariance_of_fit(std::span<const RangeMeasurement> ranges, std::span<const double> sigma_m,
                                  const PositionSolution& solution);

}  // namespace canyon::gnss
