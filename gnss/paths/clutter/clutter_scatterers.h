#pragma once

#include <complex>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/scene/scene.h"

namespace canyon::gnss {

/// A point of the street that sends signals on: a pole, a sign, a parked car.
struct ClutterScatterer {
  std::uint64_t id = 0;      ///< of its cell
  std::uint32_t number = 0;  ///< in the order in which they were first met, of the same scene
  Eigen::Vector3d p_W;
  std::complex<double> co, cross;  ///< complex normal, variance 1: what it sends into either hand
};

/// One scatterer in each square cell of the ground, evenly distributed in it and over 0 to 5 m (assumed) above the
/// terrain (z = 0 of W where there is none). All of it by the cell and the number of the street alone (stream
/// "gnss.clutter.scatterer"): every run, seed and pass meets the same. Thread-safe.
class ClutterScatterers {
 public:
  ClutterScatterers(double cell_m, std::uint64_t street) : cell_m_(cell_m), draws_(street, "gnss.clutter.scatterer") {}

  /// Those within `radius_m` of p, horizontally, and a little more; in a fixed order.
  void near(const scene::Scene& scene, const Eigen::Vector3d& p_W, double radius_m,
            std::vector<ClutterScatterer>& out) const;

 private:
  ClutterScatterer make(const scene::Scene& scene, int x, int y) const;

  double cell_m_;
  RandomStream draws_;
  mutable std::mutex mutex_;
  mutable const scene::Scene* scene_ = nullptr;
  mutable std::map<std::pair<int, int>, ClutterScatterer> made_;
};

}  // namespace canyon::gnss
