#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "canyon/core/random/random.h"
#include "canyon/inertial/errors/imu_block.h"

namespace canyon::inertial {

/// A first-order process on three axes at the ends of equal intervals, b_(k+1) = phi b_k + drive n_k, without
/// discretization error: Gauss-Markov (phi = exp(-dt / tau), started stationary) or random walk (phi = 1, started at
/// zero). Variance and correlation are those of the continuous process at any sample rate.
///
/// Any block of samples is reached without the draws of those before it: the values at the borders of blocks are a
/// process of their own, with the exact transition over a whole block, and inside a block the process is the bridge
/// between its two borders (a free path plus the part of its end's miss that the end explains). Value k depends on
/// (seed, name, n, k) alone; reaching block j costs at most j steps of the border process.
class MarkovProcess {
 public:
  /// Streams `name` (entity = axis, index = interval) and `name`.border (index = block), both with draw number `n`.
  /// sigma >= 0 in the unit of the value; tau_s, dt_s > 0.
  static MarkovProcess gauss_markov(std::uint64_t seed, const std::string& name, std::uint32_t n, double sigma,
                                    double tau_s, double dt_s);
  /// `per_sqrt_s`: growth of the standard deviation, value per root second.
  static MarkovProcess random_walk(std::uint64_t seed, const std::string& name, std::uint32_t n, double per_sqrt_s,
                                   double dt_s);

  /// Value at the start of interval k >= 0.
  Eigen::Vector3d at(std::int64_t k);
  /// Adds the mean over each interval of block `number`, given the values at its ends: weight (b_k + b_(k+1)), weight =
  /// tanh(dt / 2 tau) tau / dt (1/2 for a random walk). What the ends leave open is white and independent of all else,
  /// with the standard deviation within_sigma() of each mean (0 where dt < 0.0034 tau: below 1e-6 of the density).
  void add_means(std::int64_t number, AxisArrays& out);
  double within_sigma() const { return within_sigma_; }

 private:
  MarkovProcess(std::uint64_t seed, const std::string& name, std::uint32_t n);
  void go_to(std::int64_t number);
  Eigen::Vector3d border_step(std::int64_t to, const Eigen::Vector3d& from) const;

  RandomStream draws_, borders_;
  std::uint32_t n_;
  double start_sigma_ = 0.0;
  double phi_ = 1.0, drive_ = 0.0;              ///< of one interval
  double block_phi_ = 1.0, block_drive_ = 0.0;  ///< of one block
  double weight_ = 0.5, within_sigma_ = 0.0;    ///< of the mean over an interval
  std::array<double, kImuBlock> bridge_{};      ///< share of the miss at the end that is owed to each value
  std::int64_t number_ = -1;                    ///< block that is held
  Eigen::Vector3d left_ = Eigen::Vector3d::Zero(), right_ = left_;  ///< its borders
  std::array<std::array<double, kImuBlock + 1>, 3> values_{};
};

}  // namespace canyon::inertial
