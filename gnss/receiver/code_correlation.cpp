#include "canyon/gnss/receiver/code_correlation.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "canyon/core/check.h"
#include "canyon/core/units.h"

namespace canyon::gnss {
namespace {

constexpr std::array<const char*, kModulations> kNames{"bpsk0.5", "bpsk1", "bpsk2", "bpsk10", "boc11"};
constexpr double kTableEndChips = 4.0;

std::vector<CodeCorrelation::Kink> kinks_of(Modulation modulation) {
  if (modulation == Modulation::kBoc11) return {{-1.0, -1.0}, {-0.5, 4.0}, {0.0, -6.0}, {0.5, 4.0}, {1.0, -1.0}};
  return {{-1.0, 1.0}, {0.0, -2.0}, {1.0, 1.0}};
}

}  // namespace

Modulation modulation_of(std::string_view name) {
  const auto it = std::find(kNames.begin(), kNames.end(), name);
  CANYON_CHECK(it != kNames.end(), "modulation \"", name, "\"");
  return static_cast<Modulation>(it - kNames.begin());
}

double chip_rate_hz(Modulation modulation) {
  switch (modulation) {
    case Modulation::kBpsk05:
      return 0.511e6;
    case Modulation::kBpsk2:
      return 2.046e6;
    case Modulation::kBpsk10:
      return 10.23e6;
    case Modulation::kBpsk1:
    case Modulation::kBoc11:
      break;
  }
  return 1.023e6;
}

Modulation modulation_of(GnssSystem system, int band) {
  if (system == GnssSystem::kBeidou && band == 7) return Modulation::kBpsk2;  // B2I
  if (band >= 5) return Modulation::kBpsk10;
  switch (system) {
    case GnssSystem::kGlonass:
      return Modulation::kBpsk05;
    case GnssSystem::kGalileo:
      return Modulation::kBoc11;
    case GnssSystem::kBeidou:
      return band == 1 ? Modulation::kBoc11 : Modulation::kBpsk2;
    case GnssSystem::kGps:
    case GnssSystem::kQzss:
    case GnssSystem::kSbas:
      break;
  }
  return Modulation::kBpsk1;
}

double sine_integral(double x) {
  const double a = std::abs(x);
  if (a < 4.0) {
    double term = x, sum = x;
    for (int n = 3; std::abs(term) > 1e-17; n += 2) {
      term *= -x * x / ((n - 1.0) * n);
      sum += term / n;
    }
    return sum;
  }
  // Si(x) = pi/2 + Im E1(jx), with the exponential integral's continued fraction (Abramowitz & Stegun 5.1.22) by the
  // modified Lentz method.
  const std::complex<double> z(0.0, a);
  std::complex<double> b = z + 1.0, c = 1e300, d = 1.0 / b, h = d;
  for (int i = 1; i < 200; ++i) {
    const double k = -static_cast<double>(i) * i;
    b += 2.0;
    d = 1.0 / (k * d + b);
    c = b + k / c;
    const std::complex<double> factor = c * d;
    h *= factor;
    if (std::abs(factor - 1.0) < 1e-16) break;
  }
  const double value = kPi / 2.0 + (std::polar(1.0, -a) * h).imag();
  return x < 0.0 ? -value : value;
}

CodeCorrelation::CodeCorrelation(Modulation modulation, double bandwidth_hz)
    : kinks_(kinks_of(modulation)),
      chip_m_(kSpeedOfLight / chip_rate_hz(modulation)),
      bandwidth_(bandwidth_hz / chip_rate_hz(modulation)) {
  CANYON_CHECK(bandwidth_ == 0.0 || bandwidth_ >= 1.0, "bandwidth_hz = ", bandwidth_hz, " at a chip rate of ",
               chip_rate_hz(modulation), " Hz");
  if (bandwidth_ == 0.0) return;
  // Cubic interpolation between nodes: the fourth derivative of R is about w pi^2 B^3 / 3, so this step keeps the error
  // below 1e-6 of the peak.
  step_ = std::min(1.0 / 256.0, 1.0 / (24.0 * bandwidth_));
  const auto nodes = static_cast<std::size_t>(std::ceil(kTableEndChips / step_)) + 2;
  table_.reserve(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    const double x = static_cast<double>(i) * step_;
    table_.push_back({exact(x), exact_slope(x)});
  }
}

double CodeCorrelation::exact(double x) const {
  double sum = 0.0;
  for (const Kink& k : kinks_) {
    const double u = x - k.at_chips;
    if (bandwidth_ == 0.0) {
      sum += 0.5 * k.slope_change * std::abs(u);
    } else {
      const double v = kPi * bandwidth_ * u;
      sum += k.slope_change * (u * sine_integral(v) + std::cos(v) / (kPi * bandwidth_)) / kPi;
    }
  }
  return sum;
}

double CodeCorrelation::exact_slope(double x) const {
  double sum = 0.0;
  for (const Kink& k : kinks_) {
    const double u = x - k.at_chips;
    if (bandwidth_ == 0.0)
      sum += 0.5 * k.slope_change * (u > 0.0 ? 1.0 : (u < 0.0 ? -1.0 : 0.0));
    else
      sum += k.slope_change * sine_integral(kPi * bandwidth_ * u) / kPi;
  }
  return sum;
}

double CodeCorrelation::at(double x_chips) const {
  const double a = std::abs(x_chips);
  if (!band_limited()) return a >= 1.0 ? 0.0 : exact(a);
  if (a >= kTableEndChips) return exact(a);
  const double u = a / step_;
  const auto i = static_cast<std::size_t>(u);
  const double s = u - static_cast<double>(i);
  const Node &p = table_[i], &q = table_[i + 1];
  const double rise = q.value - p.value, m0 = p.slope * step_, m1 = q.slope * step_;
  return p.value + s * (m0 + s * (3.0 * rise - 2.0 * m0 - m1 + s * (m0 + m1 - 2.0 * rise)));
}

double CodeCorrelation::slope(double x_chips) const {
  if (!band_limited() && std::abs(x_chips) > 1.0) return 0.0;
  return exact_slope(x_chips);
}

}  // namespace canyon::gnss
