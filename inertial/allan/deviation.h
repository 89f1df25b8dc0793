#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace canyon::inertial {

/// Deviation of a rate over averaging time, in the rate's unit.
struct DeviationPoint {
  double tau_s = 0.0;
  std::int64_t m = 0;  ///< tau in samples
  double deviation = 0.0;
  double low = 0.0, high = 0.0;  ///< confidence interval, from chi-square with `edf` degrees of freedom
  double edf = 0.0;  ///< equivalent degrees of freedom for the noise type that the slope shows there, summed
                     ///< over the segments (degrees_of_freedom.h)
};

/// A stretch of samples without a gap: [begin, end).
struct Segment {
  std::size_t begin = 0, end = 0;
};

/// Time differences of a log and the stretches between its gaps.
struct Sampling {
  double interval_s = 0.0;  ///< mean interval within the segments
  std::vector<Segment> segments;
  double jitter_s = 0.0;  ///< standard deviation of the intervals within the segments
};
/// A gap is an interval longer than `gap_factor` times the usual one that the samples after it do not make up: time
/// stamps of a host come late and in bursts, and a burst after a stall has lost nothing. Jitter within a segment is
/// taken for the host's and not the sensor's: samples count as equally spaced there. Times must increase.
Sampling sampling_of(std::span<const double> t_s, double gap_factor = 5.0);

/// Averaging factors: every octave of the sample interval and `per_octave` values to each, up to what leaves at least
/// nine independent averages.
std::vector<std::int64_t> averaging_factors(std::int64_t samples, int per_octave);

/// Names of the deviations: overlapping, modified, hadamard, total.
std::vector<std::string> deviation_kinds();

/// Deviation of equally spaced rate samples, by name of its row. Differences are taken within segments only and
/// averaged over all of them; factors for which no segment is long enough are left out. Same bits for any number of
/// threads. `confidence`: probability that the interval holds the true deviation.
///
/// overlapping: Allan deviation with all overlapping differences (IEEE 1139-2008, eq. A.6). modified: the same of phase
/// averaged over tau (Allan & Barnes 1981). hadamard: second differences of the rate, blind to a linear drift (Baugh
/// 1971), overlapping. total: overlapping on data extended by reflection at both ends (Greenhall, Howe & Percival
/// 1999); each segment is extended by itself. Its value is the definition's, which lies low where flicker noise or
/// random walk rule (by 0.24 and 0.38 of tau / T); its interval is that of the true deviation.
std::vector<DeviationPoint> deviation(const std::string& kind, std::span<const double> rate, const Sampling& sampling,
                                      std::span<const std::int64_t> factors, double confidence = 0.95);

}  // namespace canyon::inertial
