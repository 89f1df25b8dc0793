#include "canyon/fusion/verdict/error_record.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "canyon/core/math/chi_square.h"
#include "canyon/core/messages.h"

namespace canyon::fusion {
namespace {

constexpr double kMostErrors = 1e6;  // sigma

}  // namespace

double BlockErrors::coverage(std::size_t share) const {
  return series.samples() > 0 ? static_cast<double>(within[share]) / static_cast<double>(series.samples()) : kNaN;
}

ErrorRecord::ErrorRecord(const std::vector<BlockKind>& kinds) {
  for (const BlockKind& kind : kinds) {
    BlockErrors block;
    block.name = kind.name;
    block.series = NormalSeries(static_cast<int>(kind.axes.size()));
    for (const std::string& axis : kind.axes) {
      block.axes.emplace_back();
      block.axes.back().name = axis;
      block.axes.back().unit = kind.unit;
    }
    for (std::size_t i = 0; i < block.edges.size(); ++i)
      block.edges[i] = chi_square_threshold(1.0 - BlockErrors::kShares[i], static_cast<double>(kind.axes.size()));
    blocks_.push_back(std::move(block));
  }
}

std::vector<BlockKind> ErrorRecord::navigation() {
  return {{"attitude", "deg", {"roll", "pitch", "yaw"}},
          {"position", "m", {"east", "north"}},
          {"height", "m", {"height"}},
          {"velocity", "m/s", {"east velocity", "north velocity", "vertical velocity"}}};
}

void ErrorRecord::add(std::size_t index, GpsTime t, const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  if (!error.allFinite() || !covariance.allFinite()) return;
  BlockErrors& block = blocks_[index];
  const auto n = error.size();
  const auto whole = covariance.llt();
  Eigen::VectorXd z = Eigen::VectorXd::Constant(n, kMostErrors);
  if (whole.info() == Eigen::Success) z = whole.matrixL().solve(error).cwiseMin(kMostErrors).cwiseMax(-kMostErrors);
  block.series.add(t, z);
  for (std::size_t i = 0; i < block.within.size(); ++i) block.within[i] += z.squaredNorm() <= block.edges[i] ? 1 : 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    AxisErrors& axis = block.axes[static_cast<std::size_t>(i)];
    axis.error_squares += error[i] * error[i];
    axis.variances += covariance(i, i);
    const double sigma = std::sqrt(std::max(covariance(i, i), 0.0));
    const double ratio = std::min(std::abs(error[i]), kMostErrors * sigma) > 0.0 ? error[i] / sigma : 0.0;
    axis.series.add(t, Eigen::VectorXd::Constant(1, std::isfinite(ratio) ? ratio : kMostErrors));
  }
}

}  // namespace canyon::fusion
