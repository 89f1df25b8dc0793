#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/random.h"

namespace canyon::inertial {

/// First-order Gauss-Markov process on three axes, sampled at a fixed interval without discretization error:
///   b_0 = sigma n_0,   b_k = phi b_(k-1) + sigma sqrt(1 - phi^2) n_k,   phi = exp(-dt / tau),
/// so that its variance is sigma^2 and its correlation exp(-|t| / tau) at any sample rate. Started stationary.
/// The value depends on (stream, k) only; going forward costs one draw per axis and step, going back starts over.
class GaussMarkov {
 public:
  /// sigma in the unit of the value, >= 0; tau_s and dt_s > 0.
  GaussMarkov(RandomStream stream, double sigma, double tau_s, double dt_s);

  /// Value at sample k >= 0.
  const Eigen::Vector3d& at(std::int64_t k);

 private:
  RandomStream stream_;
  double sigma_, phi_, drive_;
  std::int64_t k_ = -1;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
};

}  // namespace canyon::inertial
