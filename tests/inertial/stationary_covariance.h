#pragma once

#include "canyon/core/check.h"
#include "canyon/inertial/mems/linear_plant.h"

namespace canyon::testing {}
namespace canyon::inertial::testing {
using namespace canyon::testing;  // so that testing:: is both

/// Covariance that the noise of repeated steps leads to: P = phi P phi^T + covariance. phi must be stable.
inline Eigen::MatrixXd stationary_covariance(const DiscretePlant& step) {
  Eigen::MatrixXd phi = step.phi, sum = step.covariance;
  // Doubling: 2^k steps at the k-th turn.
  for (int k = 0; k < 64; ++k) {
    const Eigen::MatrixXd more = phi * sum * phi.transpose();
    sum += more;
    phi *= phi.eval();
    if (phi.cwiseAbs().maxCoeff() < 1e-20) return sum;
    CANYON_CHECK(phi.allFinite(), "the step is not stable");
  }
  CANYON_CHECK(false, "the step is not stable: ", phi.cwiseAbs().maxCoeff());
  return sum;
}

}  // namespace canyon::inertial::testing
