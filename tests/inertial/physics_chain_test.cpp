#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "core/units.h"
#include "inertial/allan/deviation.h"
#include "inertial/error_chain.h"
#include "inertial/mems/element_model.h"
#include "inertial/paper_formulas.h"

namespace canyon::inertial {
namespace {

ImuSample resting(double rate_hz) {
  ImuSample s;
  s.dt_s = 1.0 / rate_hz;
  s.dv_U = Eigen::Vector3d(0.0, 0.0, kStandardGravity) * s.dt_s;
  return s;
}

// The thermal density of the catalogue's parts: that of the equation simulated against sqrt(4 k_B T w0 / (m Q)), and
// the share of the sheet's density that it explains. The paper takes it for the whole.
TEST(PhysicsChain, ThermalDensityOfTheCatalogue) {
  int parts = 0;
  for (const std::string& name : catalogue_names()) {
    const CatalogueEntry e = *load_catalogue_entry(name);
    if (!e.mems.given) continue;
    ++parts;
    const ElementFigures& f = e.mems.accel;
    const auto model = accelerometer_model(f, e.mems.temperature_k);
    ASSERT_TRUE(model.ok()) << name;
    const double w0 = 2.0 * kPi * f.resonance_hz;
    const double formula = accel_thermal_density(e.mems.temperature_k, w0, f.mass_kg, f.quality_factor);
    EXPECT_NEAR(std::sqrt(2.0) * model->thermal_n / formula, 1.0, 1e-12) << name;
    const double sheet = e.noise().accel.white_per_sqrt_hz;
    std::printf("%-16s thermal %6.2f ug/sqrt(Hz), %2.0f %% of the sheet's %6.1f; pick-off %5.2f\n", name.c_str(),
                formula / kMilliG * 1e3, 100.0 * formula / sheet, sheet / kMilliG * 1e3,
                std::sqrt(2.0) * model->pick_off_n / kMilliG * 1e3);
    EXPECT_GT(formula / sheet, 0.02) << name;
    EXPECT_LT(formula / sheet, 0.8) << name;
    EXPECT_TRUE(make_physics_chain({.entry = e}).ok()) << name;
  }
  EXPECT_GE(parts, 7);
}

// The noise of the whole chain at low frequency is the sheet's, made of mass, pick-off and electronics; nothing of the
// resonance is folded in. 4 sigma of 1250 averages: false alarm 6e-5.
TEST(PhysicsChain, WhiteNoiseIsTheSheets) {
  const CatalogueEntry e = *load_catalogue_entry("adis16470");
  ChainSetup setup{.entry = e, .seed = 3, .rate_hz = 200.0};
  setup.leave_out = {"turn_on_bias", "in_run_bias",  "flicker",      "rate_random_walk", "scale_factor",
                     "misalignment", "quantization", "nonlinearity", "g_sensitivity"};
  auto chain = *make_physics_chain(setup);
  const int blocks = 1250, length = 40;
  Eigen::Vector3d angle2 = Eigen::Vector3d::Zero(), speed2 = angle2;
  std::int64_t k = 0;
  for (int b = 0; b < blocks; ++b) {
    Eigen::Vector3d angle = Eigen::Vector3d::Zero(), speed = angle;
    for (int i = 0; i < length; ++i, ++k) {
      ImuSample s;
      s.dt_s = 1.0 / 200.0;
      chain->corrupt(k, s);
      angle += s.dtheta_U;
      speed += s.dv_U;
    }
    angle2 += angle.cwiseAbs2();
    speed2 += speed.cwiseAbs2();
  }
  const double n = 3.0 * blocks, t_s = length / 200.0, band = 4.0 * std::sqrt(2.0 / n);
  // The filters' memory (5 ms) takes a little off the variance of averages over 200 ms.
  EXPECT_NEAR(angle2.sum() / n / t_s / std::pow(e.noise().gyro.white_per_sqrt_hz, 2), 1.0, band + 0.03);
  EXPECT_NEAR(speed2.sum() / n / t_s / std::pow(e.noise().accel.white_per_sqrt_hz, 2), 1.0, band + 0.03);
  EXPECT_EQ(chain->noise().accel.white_per_sqrt_hz, e.noise().accel.white_per_sqrt_hz);
}

TEST(PhysicsChain, RestIsReadAsRest) {
  CatalogueEntry e = *load_catalogue_entry("adxl355");
  ChainSetup setup{.entry = e, .seed = 3, .rate_hz = 100.0};
  setup.leave_out = {"turn_on_bias", "in_run_bias",  "flicker",    "scale_factor",
                     "misalignment", "nonlinearity", "temperature"};
  auto chain = *make_physics_chain(setup);
  for (int k = 0; k < 20; ++k) {
    ImuSample s = resting(100.0);
    chain->corrupt(k, s);
    // Curve of the electrodes at 1 g: (x / gap)^2 = 5e-4^2...; noise 6 sigma of N / sqrt(dt), and the output's step.
    const double noise = 6.0 * e.noise().accel.white_per_sqrt_hz * 10.0 + 0.004 * kMilliG;
    EXPECT_NEAR(s.dv_U.z() * 100.0, kStandardGravity, noise + kStandardGravity * 1e-3) << k;
    EXPECT_NEAR(s.dv_U.x() * 100.0, 0.0, noise) << k;
  }
}

TEST(PhysicsChain, NeedsItsFiguresAndRoomForThem) {
  EXPECT_EQ(make_physics_chain({.entry = *load_catalogue_entry("adis16405")}).error().str(),
            "imu.errors: sensor \"adis16405\" has no proof masses, expected a sensor with a [mems] table, such as "
            "\"high_grade_mems\"");
  CatalogueEntry light = *load_catalogue_entry("adxl355");
  light.mems.accel.mass_kg = 1e-10;
  light.mems.accel.pick_off = "piezoresistive";
  const auto refused = make_physics_chain({.entry = light});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().key, "mems.accel.mass_kg");
  EXPECT_EQ(refused.error().expected, "a heavier mass, a larger quality factor or a better pick-off");
}

}  // namespace
}  // namespace canyon::inertial
