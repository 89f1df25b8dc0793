#include <cmath>
#include <limits>

#include "canyon/core/check.h"
#include "canyon/core/math/singular_values.h"
#include "canyon/gnss/solver/position_solver.h"
#include "canyon/gnss/solver/receiver_clocks.h"

namespace canyon::gnss {
namespace {

Dop from_design(const Eigen::MatrixXd& H, bool clock) {
  Dop dop;
  if (H.rows() < H.cols()) return dop;
  // Singular values instead of the normal equations: these would lose half the digits, and coplanar geometries their
  // GDOP.
  const SingularValues svd(H);
  // One that is rounding is 0: a dilution of 1e16 is no number of anything.
  const double rounding = static_cast<double>(H.rows()) * std::numeric_limits<double>::epsilon() * svd.values(0);
  const Eigen::VectorXd values = (svd.values.array() > rounding).select(svd.values, 0.0);
  const Eigen::MatrixXd scaled = svd.V * values.cwiseInverse().asDiagonal();
  // A singular value of 0 exactly: what has no part in its direction comes out as 0 * infinity.
  const auto infinite = [](double v) { return std::isnan(v) ? std::numeric_limits<double>::infinity() : v; };
  const Eigen::VectorXd variance = scaled.rowwise().squaredNorm().unaryExpr(infinite);
  dop.hdop = std::sqrt(variance(0) + variance(1));
  dop.vdop = std::sqrt(variance(2));
  dop.pdop = std::sqrt(variance.head<3>().sum());
  dop.gdop = std::sqrt(variance.head(clock ? 4 : 3).sum());
  if (clock) dop.tdop = std::sqrt(variance(3));
  return dop;
}

}  // namespace

Dop dilution_of_precision(std::span<const Eigen::Vector3d> lines, const Eigen::Matrix3d& R_E_enu, bool clock) {
  if (clock) {
    const std::vector<GnssSystem> one(lines.size(), GnssSystem::kGps);
    return dilution_of_precision(lines, one, R_E_enu);
  }
  Eigen::MatrixXd H(static_cast<Eigen::Index>(lines.size()), 3);
  for (std::size_t i = 0; i < lines.size(); ++i)
    H.row(static_cast<Eigen::Index>(i)) = -(R_E_enu.transpose() * lines[i]).transpose();
  return from_design(H, false);
}

Dop dilution_of_precision(std::span<const Eigen::Vector3d> lines, std::span<const GnssSystem> systems,
                          const Eigen::Matrix3d& R_E_enu) {
  CANYON_CHECK(lines.size() == systems.size(), lines.size(), " lines of sight, ", systems.size(), " systems");
  if (lines.size() < 4) return {};
  const ReceiverClocks clocks(systems);
  Eigen::MatrixXd H =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(lines.size()), 3 + static_cast<Eigen::Index>(clocks.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    H.block<1, 3>(row, 0) = -(R_E_enu.transpose() * lines[i]).transpose();
    H(row, 3 + static_cast<Eigen::Index>(clocks.index(systems[i]))) = 1.0;
  }
  return from_design(H, true);
}

}  // namespace canyon::gnss
