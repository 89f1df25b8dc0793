#include "canyon/inertial/errors/markov_process.h"

#include <cmath>

#include "canyon/core/check.h"

namespace canyon::inertial {
namespace {

/// 2 x - 4 tanh(x / 2) without cancellation: variance of the integral over an interval between two known values, in
/// sigma^2 tau^2, of a Gauss-Markov process with x = dt / tau.
double bridge_integral(double x) {
  if (x > 0.02) return 2.0 * x - 4.0 * std::tanh(0.5 * x);
  const double x2 = x * x;  // the next term is 2e-13 of the first
  return x * x2 * (1.0 / 6.0 - x2 * (1.0 / 60.0 - x2 * 17.0 / 10080.0));
}

/// Below this dt / tau the part of an interval's mean that its ends leave open has less than 1e-6 of the spectral
/// density of the process itself (x^2 / 12), and is left out.
constexpr double kNegligible = 3.4e-3;

constexpr double kBlockLength = static_cast<double>(kImuBlock);

}  // namespace

MarkovProcess::MarkovProcess(std::uint64_t seed, const std::string& name, std::uint32_t n)
    : draws_(seed, name), borders_(seed, name + ".border"), n_(n) {}

MarkovProcess MarkovProcess::gauss_markov(std::uint64_t seed, const std::string& name, std::uint32_t n, double sigma,
                                          double tau_s, double dt_s) {
  CANYON_CHECK(sigma >= 0.0 && tau_s > 0.0 && dt_s > 0.0, "sigma = ", sigma, ", tau_s = ", tau_s, ", dt_s = ", dt_s);
  MarkovProcess p(seed, name, n);
  const double x = dt_s / tau_s;
  // expm1: with dt << tau the differences from 1 would cancel.
  p.start_sigma_ = sigma;
  p.phi_ = std::exp(-x);
  p.drive_ = sigma * std::sqrt(-std::expm1(-2.0 * x));
  p.block_phi_ = std::exp(-kBlockLength * x);
  p.block_drive_ = sigma * std::sqrt(-std::expm1(-2.0 * kBlockLength * x));
  p.weight_ = std::tanh(0.5 * x) / x;
  if (x > kNegligible) p.within_sigma_ = sigma * std::sqrt(bridge_integral(x)) / x;
  for (std::size_t i = 0; i < kImuBlock; ++i) {
    const auto steps = static_cast<double>(i + 1);
    p.bridge_[i] =
        std::exp(-(kBlockLength - steps) * x) * std::expm1(-2.0 * steps * x) / std::expm1(-2.0 * kBlockLength * x);
  }
  return p;
}

MarkovProcess MarkovProcess::random_walk(std::uint64_t seed, const std::string& name, std::uint32_t n,
                                         double per_sqrt_s, double dt_s) {
  CANYON_CHECK(per_sqrt_s >= 0.0 && dt_s > 0.0, "per_sqrt_s = ", per_sqrt_s, ", dt_s = ", dt_s);
  MarkovProcess p(seed, name, n);
  p.drive_ = per_sqrt_s * std::sqrt(dt_s);
  p.block_drive_ = per_sqrt_s * std::sqrt(kBlockLength * dt_s);
  p.within_sigma_ = per_sqrt_s * std::sqrt(dt_s / 12.0);  // of a Brownian bridge
  for (std::size_t i = 0; i < kImuBlock; ++i) p.bridge_[i] = static_cast<double>(i + 1) / kBlockLength;
  return p;
}

Eigen::Vector3d MarkovProcess::border_step(std::int64_t to, const Eigen::Vector3d& from) const {
  const Eigen::Vector3d draw = borders_.normal3(static_cast<std::uint64_t>(to), n_);
  return to == 0 ? Eigen::Vector3d(start_sigma_ * draw) : Eigen::Vector3d(block_phi_ * from + block_drive_ * draw);
}

void MarkovProcess::go_to(std::int64_t number) {
  if (number == number_) return;
  if (number < number_ || number_ < 0) {
    number_ = 0;
    left_ = border_step(0, left_);
    right_ = border_step(1, left_);
  }
  for (; number_ < number; ++number_) {
    left_ = right_;
    right_ = border_step(number_ + 2, left_);
  }

  const auto first = static_cast<std::uint64_t>(number) * kImuBlock;
  for (std::uint32_t axis = 0; axis < 3; ++axis)
    draws_.fill_normal(std::span(values_[axis]).subspan(1), axis, first, n_);
  // The three axes side by side: each step waits for the one before it.
  double x = left_.x(), y = left_.y(), z = left_.z();
  values_[0][0] = x;
  values_[1][0] = y;
  values_[2][0] = z;
  for (std::size_t i = 1; i <= kImuBlock; ++i) {
    x = phi_ * x + drive_ * values_[0][i];
    y = phi_ * y + drive_ * values_[1][i];
    z = phi_ * z + drive_ * values_[2][i];
    values_[0][i] = x;
    values_[1][i] = y;
    values_[2][i] = z;
  }
  const double miss[3] = {right_.x() - x, right_.y() - y, right_.z() - z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kImuBlock; ++i) values_[axis][i + 1] += bridge_[i] * miss[axis];
  }
}

Eigen::Vector3d MarkovProcess::at(std::int64_t k) {
  CANYON_CHECK(k >= 0, "sample number = ", k);
  go_to(k / static_cast<std::int64_t>(kImuBlock));
  const std::size_t i = static_cast<std::size_t>(k) % kImuBlock;
  return {values_[0][i], values_[1][i], values_[2][i]};
}

void MarkovProcess::add_means(std::int64_t number, AxisArrays& out) {
  CANYON_CHECK(number >= 0, "block number = ", number);
  go_to(number);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kImuBlock; ++i) out[axis][i] += weight_ * (values_[axis][i] + values_[axis][i + 1]);
  }
}

}  // namespace canyon::inertial
