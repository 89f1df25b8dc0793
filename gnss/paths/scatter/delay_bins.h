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
  /// Of one scatterer, both hands, without the phase of its way.
  struct Phasor {
    double co, cross, co_rad, cross_rad;
  };

  void clear() { bins_.fill({}); }
  /// What is later than the last bin is left out. `weight`: of the direction in the bin's.
  void add(const Phasor& a, double excess_m, const Eigen::Vector3d& from_W, double weight, double wavelength_m) {
    const double place = excess_m / kWidth_m;
    const auto first = static_cast<std::size_t>(place);
    if (first + 1 >= kBins) return;
    const double later = place - static_cast<double>(first);
    for (const auto& [i, share] : {std::pair{first, 1.0 - later}, std::pair{first + 1, later}}) {
      const double turn_rad = -2.0 * kPi * (excess_m - static_cast<double>(i) * kWidth_m) / wavelength_m;
      bins_[i].co += std::polar(share * a.co, a.co_rad + turn_rad);
      bins_[i].cross += std::polar(share * a.cross, a.cross_rad + turn_rad);
      bins_[i].from_W += share * share * weight * from_W;
      const double co2 = share * share * a.co * a.co, cross2 = share * share * a.cross * a.cross;
      bins_[i].co_power += co2;
      bins_[i].cross_power += cross2;
      bins_[i].by_power_W += (co2 + cross2) * from_W;
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
  std::array<Bin, kBins> bins_;
};

}  // namespace canyon::gnss
