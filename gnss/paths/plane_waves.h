#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/check.h"
#include "canyon/core/time.h"
#include "canyon/gnss/signal.h"

namespace canyon::gnss {

/// One signal of each satellite in sight, plane over the scene, as they arrive at an instant.
class PlaneWaves {
 public:
  /// All at L1. `directions_W`: unit, from the antenna to each satellite; must outlive this.
  PlaneWaves(std::span<const Eigen::Vector3d> directions_W) : directions_W_(directions_W) {}
  PlaneWaves(const std::vector<Eigen::Vector3d>& directions_W) : directions_W_(directions_W) {}
  /// Each at its own carrier, Hz, > 0; as many as directions.
  PlaneWaves(std::span<const Eigen::Vector3d> directions_W, std::span<const double> carriers_hz)
      : directions_W_(directions_W), carriers_hz_(carriers_hz) {
    CANYON_CHECK(carriers_hz.size() == directions_W.size(), carriers_hz.size(), " carriers of ", directions_W.size());
    for (const double hz : carriers_hz) CANYON_CHECK(hz > 0.0, "carrier_hz = ", hz);
  }

  /// The same at an instant, for models whose ways change with time by themselves; GPS time 0 if it is not said.
  PlaneWaves at(GpsTime t) const {
    PlaneWaves out = *this;
    out.t_ = t;
    return out;
  }

  GpsTime t() const { return t_; }
  std::size_t size() const { return directions_W_.size(); }
  bool empty() const { return directions_W_.empty(); }
  std::span<const Eigen::Vector3d> directions_W() const { return directions_W_; }
  const Eigen::Vector3d& direction_W(std::size_t i) const { return directions_W_[i]; }
  double carrier_hz(std::size_t i) const { return carriers_hz_.empty() ? kL1Hz : carriers_hz_[i]; }
  double wavelength_m(std::size_t i) const { return kSpeedOfLight / carrier_hz(i); }

  /// Of an epoch with waves; what a search may leave out it must be able to for each of them.
  double shortest_wavelength_m() const { return kSpeedOfLight / *extremes().second; }
  double longest_wavelength_m() const { return kSpeedOfLight / *extremes().first; }

 private:
  using Extremes = std::pair<const double*, const double*>;
  Extremes extremes() const {
    static constexpr double kOnly = kL1Hz;
    if (carriers_hz_.empty()) return {&kOnly, &kOnly};
    const auto [least, most] = std::minmax_element(carriers_hz_.begin(), carriers_hz_.end());
    return {&*least, &*most};
  }

  std::span<const Eigen::Vector3d> directions_W_;
  std::span<const double> carriers_hz_;
  GpsTime t_;
};

}  // namespace canyon::gnss
