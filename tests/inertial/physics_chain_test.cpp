#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/inertial/allan/deviation.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/mems/element_model.h"
#include "canyon/inertial/paper_formulas.h"

namespace canyon::inertial {
namespace {

ImuSample resting(double rate_hz) {
  ImuSample s;
  s.dt_s = 1.0 / rate_hz;
  s.dv_U = Eigen::Vector3d(0.0, 0.0, kStandardGravity) * s.dt_s;
  return s;
}

// The thermal density of the catalogue's parts: that of the equation simulated against sqrt(4 k_B T w0 / (m Q)), and
// the share of the sheet's density (sqrt(2) N, one-sided) that it explains. The paper takes it for the whole; it is
// between a fiftieth and four fifths.
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
    const double sheet = std::sqrt(2.0) * e.noise().accel.white_per_sqrt_hz;
    std::printf("%-16s thermal %6.2f ug/sqrt(Hz), %2.0f %% of the sheet's %6.1f; pick-off %5.2f\n", name.c_str(),
                formula / kMilliG * 1e3, 100.0 * formula / sheet, sheet / kMilliG * 1e3,
                std::sqrt(2.0) * model->pick_off_n / kMilliG * 1e3);
    EXPECT_GT(formula / sheet, 0.015) << name;
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
  // Curve of the electrodes at 1 g.
  const double w = 2.0 * kPi * accelerometer_model(e.mems.accel, e.mems.temperature_k)->fastest_hz;
  const double part = kStandardGravity / (w * w) / e.mems.accel.pick_off_figures.gap_m;
  for (int k = 0; k < 20; ++k) {
    ImuSample s = resting(100.0);
    chain->corrupt(k, s);
    // 6 sigma of N / sqrt(dt), and the output's step.
    const double noise = 6.0 * e.noise().accel.white_per_sqrt_hz * 10.0 + 0.004 * kMilliG;
    EXPECT_NEAR(s.dv_U.z() * 100.0, kStandardGravity / (1.0 - part * part), noise) << k;
    EXPECT_NEAR(s.dv_U.x() * 100.0, 0.0, noise) << k;
  }
}

// A part of a run, begun memory() samples before, is that part of the whole run: to rounding, as 1e-16 of the state at
// its beginning is left.
TEST(PhysicsChain, PartsOfARunAreTheWholes) {
  const CatalogueEntry e = *load_catalogue_entry("bmi088");
  const auto moving = [](std::int64_t k) {
    ImuSample s;
    s.dt_s = 0.005;
    const double t = 0.005 * static_cast<double>(k);
    s.dtheta_U = Eigen::Vector3d(std::sin(t), 0.5 * std::cos(2.0 * t), 0.3) * s.dt_s;
    s.dv_U = Eigen::Vector3d(std::cos(3.0 * t), 2.0 * std::sin(t), 9.81) * s.dt_s;
    return s;
  };
  const ChainSetup setup{.entry = e, .seed = 3, .rate_hz = 200.0};
  auto whole = *make_physics_chain(setup), part = *make_physics_chain(setup);
  const std::int64_t memory = part->memory(), first = memory + 100;
  EXPECT_GT(memory, 2);
  EXPECT_LT(memory, 2000);
  std::vector<ImuSample> all;
  for (std::int64_t k = 0; k < first + 50; ++k) {
    all.push_back(moving(k));
    whole->corrupt(k, all.back());
  }
  for (std::int64_t k = first - memory; k < first + 50; ++k) {
    ImuSample s = moving(k);
    part->corrupt(k, s);
    if (k < first) continue;
    const ImuSample& expected = all[static_cast<std::size_t>(k)];
    // The output's steps: a value on the edge of one may fall to either side.
    const double angle_step = e.figures().gyro.resolution * 0.005, speed_step = e.figures().accel.resolution * 0.005;
    EXPECT_LT((s.dtheta_U - expected.dtheta_U).cwiseAbs().maxCoeff(), 1.01 * angle_step) << k;
    EXPECT_LT((s.dv_U - expected.dv_U).cwiseAbs().maxCoeff(), 1.01 * speed_step) << k;
  }
  // Without the steps, the same to rounding.
  CatalogueEntry fine = e;
  fine.gyro.resolution_deg_per_s.value = fine.accel.resolution_mg.value = 0.0;
  auto one = *make_physics_chain({.entry = fine, .seed = 3, .rate_hz = 200.0});
  auto two = *make_physics_chain({.entry = fine, .seed = 3, .rate_hz = 200.0});
  for (std::int64_t k = 0; k < first + 50; ++k) {
    ImuSample a = moving(k), b = moving(k);
    one->corrupt(k, a);
    if (k >= first - memory) two->corrupt(k, b);
    if (k >= first) {
      EXPECT_LT((a.dtheta_U - b.dtheta_U).norm(), 1e-15) << k;
      EXPECT_LT((a.dv_U - b.dv_U).norm(), 1e-14) << k;
    }
  }
}

TEST(PhysicsChain, OutputStaysWithinTheRange) {
  CatalogueEntry e = *load_catalogue_entry("adxl355");
  auto chain = *make_physics_chain({.entry = e, .seed = 3, .rate_hz = 100.0});
  for (int k = 0; k < 20; ++k) {
    ImuSample s;
    s.dt_s = 0.01;
    s.dv_U = Eigen::Vector3d(5.0, -5.0, 5.0) * kStandardGravity * s.dt_s;
    chain->corrupt(k, s);
    EXPECT_LE(s.dv_U.cwiseAbs().maxCoeff(), (2.0 + 1e-5) * kStandardGravity * s.dt_s) << k;
  }
}

TEST(PhysicsChain, RefusesAnIntegratorThatDiverges) {
  CatalogueEntry e = *load_catalogue_entry("adxl345");
  e.mems.integrator = "rk4";
  const auto refused = make_physics_chain({.entry = e, .rate_hz = 125.0});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().key, "imu.sensor, imu.rate_hz");
  EXPECT_EQ(refused.error().expected, "mems.integrator = \"exact\", or an imu.rate_hz that is high enough");
  EXPECT_NE(refused.error().what.find("with every sample at 125 Hz: it diverges"), std::string::npos)
      << refused.error().str();
  for (const char* stable : {"exact", "implicit_midpoint", "backward_euler"}) {
    e.mems.integrator = stable;
    EXPECT_TRUE(make_physics_chain({.entry = e, .rate_hz = 125.0}).ok()) << stable;
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
