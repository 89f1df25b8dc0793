#include "inertial/gauss_markov.h"

#include <cmath>

#include "core/check.h"

namespace canyon::inertial {

GaussMarkov::GaussMarkov(RandomStream stream, double sigma, double tau_s, double dt_s)
    : stream_(stream),
      sigma_(sigma),
      phi_(std::exp(-dt_s / tau_s)),
      drive_(sigma * std::sqrt(-std::expm1(-2.0 * dt_s / tau_s))) {  // expm1: dt << tau would cancel
  CANYON_CHECK(sigma >= 0.0 && tau_s > 0.0 && dt_s > 0.0, "sigma = ", sigma, ", tau_s = ", tau_s, ", dt_s = ", dt_s);
}

const Eigen::Vector3d& GaussMarkov::at(std::int64_t k) {
  CANYON_CHECK(k >= 0, "sample number = ", k);
  if (sigma_ == 0.0) return value_;
  if (k < k_) k_ = -1;
  if (k_ < 0) {
    k_ = 0;
    value_ = sigma_ * stream_.normal3(0);
  }
  while (k_ < k) {
    ++k_;
    value_ = phi_ * value_ + drive_ * stream_.normal3(static_cast<std::uint64_t>(k_));
  }
  return value_;
}

}  // namespace canyon::inertial
