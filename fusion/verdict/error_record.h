#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "canyon/fusion/verdict/normal_series.h"

namespace canyon::fusion {

/// What was said of one axis, and how it was.
struct AxisErrors {
  std::string name, unit;
  double error_squares = 0.0, variances = 0.0;
  NormalSeries series;  ///< error / sigma
};

/// Errors against the truth of quantities that belong together, with the covariance that the filter gave them.
struct BlockErrors {
  static constexpr std::array<double, 3> kShares = {0.5, 0.95, 0.997};

  std::string name;
  std::vector<AxisErrors> axes;
  /// L^-1 error, covariance = L L': their squares add up to NEES.
  NormalSeries series;
  /// How many errors lie within the ellipsoid that should hold so many of them.
  std::array<std::int64_t, 3> within{};
  std::array<double, 3> edges{};  ///< of those ellipsoids: squares of Mahalanobis distances

  double coverage(std::size_t share) const;
};

/// What a block is, and its axes: of errors in the given unit.
struct BlockKind {
  std::string name, unit;
  std::vector<std::string> axes;
};

/// The errors of a run, block by block.
class ErrorRecord {
 public:
  explicit ErrorRecord(const std::vector<BlockKind>& kinds);
  /// Attitude (roll, pitch, yaw; deg), position (east, north, and height by itself; m), velocity (east, north, up).
  static std::vector<BlockKind> navigation();
  enum { kAttitude, kPosition, kHeight, kVelocity };

  /// Estimate minus truth, in the block's unit. One that is not finite is left out, and a covariance that is not
  /// positive definite counts as infinitely sure: errors of 1e6 sigma.
  void add(std::size_t block, GpsTime t, const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);
  const std::vector<BlockErrors>& blocks() const { return blocks_; }

 private:
  std::vector<BlockErrors> blocks_;
};

}  // namespace canyon::fusion
