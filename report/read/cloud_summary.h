#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/result.h"

namespace canyon::report {

/// Squares on the ground over which the points of a map are gathered; row 0 is the northernmost.
struct MapGrid {
  Eigen::Vector2d min_W = Eigen::Vector2d::Zero();  ///< south-west corner
  double cell_m = 1.0;
  std::size_t columns = 0, rows = 0;

  /// Over a rectangle, with `cells` squares along its longer side.
  static MapGrid over(const Eigen::Vector2d& min_W, const Eigen::Vector2d& max_W, std::size_t cells);
};

/// Logarithmic bins of point error.
struct ErrorBins {
  static constexpr double kMin_m = 1e-3;
  static constexpr double kMax_m = 1e2;
  static constexpr std::size_t kPerDecade = 20;
  static constexpr std::size_t kCount = 5 * kPerDecade;
  /// Lower edge of bin i; i = kCount gives kMax_m.
  static double edge_m(std::size_t i);
};

/// What the report keeps of a map cloud, however many points it has.
struct CloudSummary {
  std::uint64_t points = 0;     ///< with a finite place and error
  std::uint64_t undefined = 0;  ///< points without
  std::uint64_t outside = 0;    ///< of `points`, those outside the grid
  double sum_squares_m2 = 0.0;
  double max_m = 0.0;
  std::uint64_t at_max = 0;              ///< points whose error is exactly max_m: many where the scorer caps distances
  std::vector<std::uint64_t> histogram;  ///< kCount + 2 bins: below kMin_m, the bins, kMax_m and above
  std::vector<float> cell_rms_m;         ///< RMS error of the points over each cell; negative where there is none

  double rms_m() const;
  /// Share of points with an error below edge_m(i).
  double share_below_edge(std::size_t i) const;
  /// Quantile out of the histogram, interpolated in the logarithm inside a bin; NaN without points.
  double quantile_m(double share) const;
};

/// Reads a binary PCD with float32 fields x, y, error (further fields are skipped) piece by piece: memory does not grow
/// with the cloud.
Result<CloudSummary> summarize_cloud(const std::string& path, const MapGrid& grid);

}  // namespace canyon::report
