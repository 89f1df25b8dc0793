#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/messages.h"

namespace canyon::gnss {

/// Spreading of a ranging signal. BPSK(n): rectangular chips at n x 1.023 MHz (GPS and QZSS C/A and L2C n = 1, BeiDou
/// B1I and B2I n = 2, B3I, GPS L5 and Galileo E5a n = 10; GLONASS FDMA 0.511 MHz). BOC(1,1): chips at 1.023 MHz, each
/// two half-chips of opposite sign (sine phase; Galileo E1, GPS L1C, BeiDou B1C but for their small high-frequency
/// part).
enum class Modulation { kBpsk05, kBpsk1, kBpsk2, kBpsk10, kBoc11 };
inline constexpr std::size_t kModulations = 5;

/// Of "bpsk0.5", "bpsk1", "bpsk2", "bpsk10", "boc11"; throws for any other name.
Modulation modulation_of(std::string_view name);
double chip_rate_hz(Modulation modulation);
/// Of the open signal of a RINEX band digit; what is not listed above is taken as BPSK(10) at band 5 and above, BPSK(1)
/// below.
Modulation modulation_of(GnssSystem system, int band);

/// Correlation of a received code with the receiver's clean replica, real and even in the delay, as seen after an
/// ideal (brick-wall, linear-phase) front end.
///
/// With infinite bandwidth R is piecewise linear: R(x) = sum_k w_k |x - x_k| / 2 with its kinks x_k and changes of
/// slope w_k; the triangle for BPSK, for BOC(1,1) 1 - 3|x| up to half a chip and |x| - 1 up to one. A front end of
/// two-sided bandwidth B replaces |u| / 2 by (u Si(pi B u) + cos(pi B u) / (pi B)) / pi, the response of B sinc(B u)
/// integrated twice. at(0) is then below 1: that is the power which the filter takes.
class CodeCorrelation {
 public:
  struct Kink {
    double at_chips;
    double slope_change;  ///< per chip
  };

  /// `bandwidth_hz`: two-sided, of the front end; 0 = infinite. A positive one must be at least the chip rate.
  CodeCorrelation(Modulation modulation, double bandwidth_hz);

  /// At a delay in chips of the modulation.
  double at(double x_chips) const;
  /// Derivative of at(), per chip; at a kink of the infinite-bandwidth form the mean of both sides.
  double slope(double x_chips) const;

  bool band_limited() const { return !table_.empty(); }
  std::span<const Kink> kinks() const { return kinks_; }
  double chip_m() const { return chip_m_; }
  /// Front-end bandwidth times the chip's length; 0 = infinite.
  double bandwidth_per_chip_rate() const { return bandwidth_; }

 private:
  struct Node {
    double value, slope;
  };
  double exact(double x_chips) const;
  double exact_slope(double x_chips) const;

  std::vector<Kink> kinks_;
  double chip_m_;
  double bandwidth_;
  double step_ = 0.0;
  std::vector<Node> table_;  ///< of the band-limited form, from 0 on
};

/// Sine integral, Si(x) = integral of sin(t)/t from 0 to x, to about 1e-14.
double sine_integral(double x);

}  // namespace canyon::gnss
