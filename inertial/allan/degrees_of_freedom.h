#pragma once

#include <cstdint>

namespace canyon::inertial {

/// Noise of a rate by its spectrum f^alpha, as it shows at one averaging time.
enum class NoiseType { kQuantization = 2, kWhite = 0, kFlicker = -1, kRandomWalk = -2 };
/// By the local slope of a deviation on a log-log plot, tau^slope: -1 (the modified deviation's -3/2 too), -1/2, 0,
/// 1/2.
NoiseType noise_of_slope(double slope);

/// Equivalent degrees of freedom of one deviation's estimate from `samples` rates at averaging factor m; at least 1.
using DegreesOfFreedom = double(NoiseType noise, double samples, double m);

/// Overlapping Allan (Howe, Allan & Barnes 1981).
DegreesOfFreedom overlapping_degrees;
/// Modified Allan and overlapping Hadamard: the sum over the covariances of neighbouring differences (Greenhall & Riley
/// 2003, Uncertainty of stability variances based on finite differences); lags are thinned out to 64 in an average.
DegreesOfFreedom modified_degrees, hadamard_degrees;
/// Total (Greenhall, Howe & Percival 1999), for tau up to half of the log.
DegreesOfFreedom total_degrees;

/// Correlation of the overlapping Allan variances of one log of white noise at two averaging factors: averages share
/// samples. It is 1 at the same, 0.5 about an octave apart; other noises differ little.
double overlapping_correlation(double m1, double m2);

/// What the total variance lies low at long averages, as a factor of it: 1 - 0.481 tau / T for flicker, 1 - 0.750 tau /
/// T for random walk (the same).
double total_bias(NoiseType noise, double samples, double m);

}  // namespace canyon::inertial
