#include "canyon/inertial/mems/integrator.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/inertial/mems/element_model.h"
#include "canyon/tests/inertial/stationary_covariance.h"

namespace canyon::inertial {
namespace {

using testing::stationary_covariance;

/// A 5 kHz proof mass of 1 ug whose pick-off does not pull.
ElementModel proof_mass(double quality_factor) {
  ElementFigures f;
  f.quality_factor = quality_factor;
  f.pick_off = "piezoresistive";
  return *accelerometer_model(f, 300.0);
}

double amplification(const DiscretePlant& step) {
  return spectral_radius(step.phi);
}

// At 5 kHz and 125 samples/s, Q = 10, one step per sample: what the paper's "near real-time" sampling asks of a scheme.
TEST(MemsIntegrator, ResonanceFarAboveTheSampleRate) {
  const LinearPlant plant = proof_mass(10.0).mechanics;
  const double h = 1.0 / 125.0, w = 2.0 * kPi * 5000.0;
  EXPECT_NEAR(amplification(runge_kutta_4_step(plant, h)), 1.66e8, 0.005e8);
  EXPECT_NEAR(amplification(implicit_midpoint_step(plant, h)), 0.9992, 0.00005);
  EXPECT_NEAR(amplification(backward_euler_step(plant, h)), 1.0 / (w * h), 0.1 / (w * h));
  // The truth: exp(-w h / (2 Q)).
  EXPECT_NEAR(amplification(exact_step(plant, h)) / std::exp(-w * h / 20.0), 1.0, 1e-10);
}

// Exact is exact: ringing from an initial displacement and the answer to a step input, against the closed form, at any
// step. eps * w h (number of turns in radians) for the phase, times ten for the doublings.
TEST(MemsIntegrator, ExactIsTheClosedForm) {
  const double w = 2.0 * kPi * 5000.0;
  for (const double q : {0.3, 0.7, 10.0, 1e5}) {
    const LinearPlant plant = proof_mass(q).mechanics;
    for (const double h : {1e-7, 1e-5, 1e-3, 8e-3, 0.1}) {
      const DiscretePlant step = exact_step(plant, h);
      const std::complex<double> root = std::sqrt(std::complex<double>(1.0 / (4.0 * q * q) - 1.0, 0.0));
      const std::complex<double> l1 = w * (-0.5 / q + root), l2 = w * (-0.5 / q - root);
      const std::complex<double> e1 = std::exp(l1 * h), e2 = std::exp(l2 * h);
      const double position = ((l1 * e2 - l2 * e1) / (l1 - l2)).real();
      const double from_speed = (w * (e1 - e2) / (l1 - l2)).real();
      const double tolerance = 10.0 * std::max(1.0, w * h) * std::numeric_limits<double>::epsilon();
      EXPECT_NEAR(step.phi(0, 0), position, tolerance) << q << " " << h;
      EXPECT_NEAR(step.phi(0, 1), from_speed, tolerance) << q << " " << h;
      EXPECT_NEAR(step.gamma(0) * w, 1.0 - position, 4.0 * tolerance) << q << " " << h;
    }
  }
}

// Two steps are one of twice the length, noise too.
TEST(MemsIntegrator, ExactStepsCompose) {
  ElementModel model = proof_mass(3.0);
  LinearPlant plant = with_integral(in_series(model.mechanics, butterworth(2, 40.0)));
  const DiscretePlant half = exact_step(plant, 1.7e-3), whole = exact_step(plant, 3.4e-3);
  const Eigen::MatrixXd twice = half.phi * half.covariance * half.phi.transpose() + half.covariance;
  EXPECT_LT((half.phi * half.phi - whole.phi).norm(), 1e-11 * whole.phi.norm());
  const Eigen::VectorXd sigma = whole.covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < plant.size(); ++i)
    for (Eigen::Index j = 0; j < plant.size(); ++j)
      EXPECT_NEAR(twice(i, j), whole.covariance(i, j), 1e-9 * sigma(i) * sigma(j)) << i << j;
}

// Error of one period of ringing falls with the order that the table says, and the exact scheme has none.
TEST(MemsIntegrator, OrdersAreThoseOfTheTable) {
  const LinearPlant plant = proof_mass(2.0).mechanics;
  const double period = 1.0 / 5000.0;
  const DiscretePlant truth = exact_step(plant, period);
  const auto error = [&](const ModelRow<DiscretizePlant>& row, int steps) {
    const DiscretePlant step = row.make(plant, period / steps);
    Eigen::Vector2d state(1.0, 0.0);
    for (int k = 0; k < steps; ++k) state = (step.phi * state).eval();
    return (state - truth.phi.col(0)).norm();
  };
  for (const ModelRow<DiscretizePlant>& row : integrators()) {
    if (!row.order) {
      EXPECT_LT(error(row, 64), 1e-12) << row.name;
      continue;
    }
    const double order = std::log2(error(row, 200) / error(row, 400));
    EXPECT_NEAR(order, *row.order, 0.1) << row.name;
  }
}

// Equipartition by the step's own covariance: <k x^2> = k_B T and <m v^2> = k_B T from Q = 0.5 to 1e5, whatever the
// step. Schemes that hold a draw over the step get it wrong where the resonance is not resolved: backward Euler loses
// the thermal energy, the midpoint keeps it.
TEST(MemsIntegrator, StationaryEnergyIsThermal) {
  const double m = 1e-9, temperature_k = 300.0;
  for (const double q : {0.5, 0.7, 1.0, 10.0, 1e3, 1e5}) {
    const LinearPlant plant = proof_mass(q).mechanics;
    for (const double h : {1e-6, 1e-4, 8e-3}) {
      const Eigen::MatrixXd p = stationary_covariance(exact_step(plant, h));
      // Doublings lose about the number of their turns: 40 of them.
      EXPECT_NEAR(p(0, 0) * m / (kBoltzmann * temperature_k), 1.0, 1e-9) << q << " " << h;
      EXPECT_NEAR(p(1, 1) * m / (kBoltzmann * temperature_k), 1.0, 1e-9) << q << " " << h;
    }
    const Eigen::MatrixXd euler = stationary_covariance(backward_euler_step(plant, 8e-3));
    EXPECT_LT(euler(0, 0) * m / (kBoltzmann * temperature_k), 0.1) << q;
    const Eigen::MatrixXd midpoint = stationary_covariance(implicit_midpoint_step(plant, 8e-3));
    // (Solved by two million steps at Q = 1e5.)
    EXPECT_NEAR(midpoint(0, 0) * m / (kBoltzmann * temperature_k), 1.0, 1e-8) << q;
  }
}

}  // namespace
}  // namespace canyon::inertial
