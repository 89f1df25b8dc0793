#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/time.h"

namespace canyon::fusion {

/// A series in time of vectors that are unit normal if a filter is right: innovations, which are then independent of
/// one another, or errors, which are not. Keeps their mean square and how alike they are at which lag, in memory that
/// grows with the logarithm of their number: lags 1 to 16 of the samples themselves, then 9 to 16 of means of 2, 4, 8
/// ... of them (the correlator of several resolutions of light scattering: Magatti & Ferri, Applied Optics 40 (2001)
/// 4011).
///
/// Lags are counted in samples; in seconds by the mean interval, so that gaps are not seen.
class NormalSeries {
 public:
  static constexpr int kLags = 16;

  /// 1 <= dimension.
  explicit NormalSeries(int dimension = 1);

  /// Times must not go back. A vector that is not finite is left out.
  void add(GpsTime t, const Eigen::Ref<const Eigen::VectorXd>& z);

  int dimension() const { return dimension_; }
  std::int64_t samples() const { return samples_; }
  /// Between samples, s; NaN with fewer than two.
  double interval_s() const;
  /// Of all elements; NaN without samples.
  double mean_square() const;

  struct Lag {
    double samples = 0.0;     ///< how far apart
    double stands_for = 1.0;  ///< of so many lags
    /// Normalized autocorrelation about zero, all elements together: the sum over the pairs by the root of the product
    /// of the two sums of squares of what is in them, that of the earlier samples and that of the later ones. So it is
    /// 1 at most, in magnitude, however few they are; 0 where one of these sums is nothing.
    double r = 0.0;
    std::int64_t pairs = 0;
  };
  /// From the shortest on.
  std::vector<Lag> lags() const;

  /// Box-Pierce statistic over lags 1 to `degrees`, each counted with its own number of pairs: sum of r_k^2 dimension
  /// (N - k), chi-square distributed with that many degrees of freedom if all samples are independent, to 1 / N.
  struct Portmanteau {
    double statistic = 0.0;
    int degrees = 0;  ///< 0: too few samples
  };
  Portmanteau portmanteau() const;
  /// Of independent samples that determine the mean square as well as these do: N / (1 + 2 sum of (1 - k / N) r_k^2),
  /// of a Gaussian process (Priestley 1981, section 5.3.2), over all lags before the first at which r is not above what
  /// chance makes, 2 / sqrt(N dimension). At least 1.
  double effective_samples() const;
  /// After which r has fallen to 1 / e of what it is at lag one, s; 0 if it is not above chance there.
  double correlation_s() const;

 private:
  struct Level {
    std::vector<double> ring;                  ///< the last kLags vectors
    std::array<double, kLags> ring_squares{};  ///< mean of the squares of the samples that each is the mean of
    std::int64_t count = 0;
    Eigen::VectorXd half;  ///< the first of a pair
    double half_squares = 0.0;
    std::array<double, kLags> sums{}, earlier_squares{}, later_squares{};
    std::array<std::int64_t, kLags> pairs{};
  };
  void add(std::size_t level, const Eigen::VectorXd& z, double squares);
  double chance() const;

  int dimension_;
  std::int64_t samples_ = 0;
  double squares_ = 0.0;
  GpsTime first_, last_;
  std::vector<Level> levels_;
};

}  // namespace canyon::fusion
