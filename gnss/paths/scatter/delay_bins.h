#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/units.h"
#include "canyon/gnss/paths/path_model.h"

namespace canyon::gnss {

/// What many scatterers send to one satellite's signal, gathered by delay. A phasor goes to the two bins around its
/// delay, in shares that change evenly with it, and with the phase that it has at its own delay: the sum at the carrier
/// is exact, and nothing jumps as a delay passes from bin to bin; the code sees delays to half a bin.
class DelayBins {
 public:
  static constexpr double kWidth_m = 15.0;
  static constexpr std::size_t kBins = 40;

  struct Bin {
    std::complex<double> co, cross;
    Eigen::Vector3d from_W = Eigen::Vector3d::Zero();  ///< directions, by weight
    double co_power = 0.0, cross_power = 0.0;          ///< of each phasor by itself
    Eigen::Vector3d by_power_W = Eigen::Vector3d::Zero();
  };
  /// Of one scatterer, either hand, without the phase of its way.
  struct Phasor {
    std::complex<double> co, cross;
  };

  /// Empties them for a signal of that carrier.
  void clear(double wavelength_m) {
    bins_.fill({});
    per_m_ = -2.0 * kPi / wavelength_m;
    a_bin_later_ = std::polar(1.0, -per_m_ * kWidth_m);
  }
  /// What is later than the last bin is left out. `weight`: of the direction in the bin's.
  void add(const Phasor& a, double excess_m, const Eigen::Vector3d& from_W, double weight) {
    const double place = excess_m / kWidth_m;
    const auto first = static_cast<std::size_t>(place);
    if (first + 1 >= kBins) return;
    const double later = place - static_cast<double>(first);
    const double power = std::norm(a.co), cross_power = std::norm(a.cross);
    std::complex<double> turn = std::polar(1.0, per_m_ * (excess_m - static_cast<double>(first) * kWidth_m));
    for (const auto& [i, share] : {std::pair{first, 1.0 - later}, std::pair{first + 1, later}}) {
      const double share2 = share * share;
      Bin& bin = bins_[i];
      bin.co += turned(share * turn, a.co);
      bin.cross += turned(share * turn, a.cross);
      bin.from_W += share2 * weight * from_W;
      bin.co_power += share2 * power;
      bin.cross_power += share2 * cross_power;
      bin.by_power_W += share2 * (power + cross_power) * from_W;
      turn = turned(turn, a_bin_later_);
    }
  }
  const std::array<Bin, kBins>& bins() const { return bins_; }

  /// Appends what has a field of `least` at least, relative to the free direct signal; fields fade in over 6 dB above
  /// it. `kind` stands in the place of the first reflector.
  void append(double least, std::uint32_t kind, std::vector<SignalPath>& out) const {
    for (std::size_t i = 0; i < kBins; ++i) {
      const Bin& bin = bins_[i];
      const double power = bin.co_power + bin.cross_power;
      // Of the power, not of the field: what fades for a moment is still tracked through it.
      const double amplitude = std::sqrt(std::max(power, std::norm(bin.co) + std::norm(bin.cross)));
      const double kept = std::clamp(amplitude / least - 1.0, 0.0, 1.0);
      if (kept == 0.0) continue;
      SignalPath path;
      path.excess_m = static_cast<double>(i) * kWidth_m;
      path.copolar = kept * bin.co;
      path.crosspolar = kept * bin.cross;
      path.arrival_W = bin.from_W.normalized();
      path.gathered_copolar = kept * kept * bin.co_power;
      path.gathered_crosspolar = kept * kept * bin.cross_power;
      const double mean = bin.by_power_W.norm() / power;  // of unit vectors: 1 if they are one
      path.spread = std::sqrt(std::max(1.0 - mean * mean, 0.0));
      path.facets = {kind, static_cast<std::uint32_t>(i), SignalPath::kNoFacet};
      out.push_back(path);
    }
  }

 private:
  /// Their product; without the detour that C++ makes for infinite numbers.
  static std::complex<double> turned(const std::complex<double>& a, const std::complex<double>& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  }

  std::array<Bin, kBins> bins_;
  double per_m_ = 0.0;  ///< phase, rad
  std::complex<double> a_bin_later_;
};

}  // namespace canyon::gnss
