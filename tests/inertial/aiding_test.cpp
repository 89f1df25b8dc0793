#include <cmath>

#include <gtest/gtest.h>

#include "canyon/core/check.h"
#include "canyon/core/earth/standard_atmosphere.h"
#include "canyon/core/units.h"
#include "canyon/inertial/aiding/barometer.h"
#include "canyon/inertial/aiding/magnetometer.h"
#include "canyon/inertial/aiding/odometer.h"
#include "canyon/tests/support/four_sigma.h"

namespace canyon::inertial {
namespace {

using canyon::testing::four_sigma_of_variance;

const GpsTime kStart = GpsTime::from_week_sow(1590, 0.0);

BarometerConfig perfect_barometer() {
  BarometerConfig c;
  c.turn_on_bias_pa = c.drift_pa = c.noise_pa_per_sqrt_hz = c.lag_s = 0.0;
  return c;
}

TEST(Barometer, WithoutErrorsIsThePressureAboveTheGeoid) {
  BarometerConfig c = perfect_barometer();
  c.undulation_m = -27.0;
  Barometer barometer(c, 1);
  const auto r = barometer.sample(0, kStart, 73.0);
  EXPECT_EQ(r.message.pressure_pa, standard_pressure_pa(100.0));
  EXPECT_EQ(r.truth.pressure_pa, r.message.pressure_pa);
  EXPECT_EQ(r.message.t.ns, kStart.ns);
}

// 2026-11-23: drift and noise of any size made the pressure negative, and of that no atmosphere has a height.
TEST(Barometer, NeverReadsLessThanNothing) {
  BarometerConfig c = perfect_barometer();
  c.turn_on_bias_pa = 1e6;
  int none = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double read_pa = Barometer(c, seed).sample(0, kStart, 0.0).message.pressure_pa;
    EXPECT_GE(read_pa, 0.0);
    EXPECT_TRUE(std::isfinite(standard_height_m(read_pa)));
    none += read_pa == 0.0 ? 1 : 0;
  }
  EXPECT_GT(none, 0);
}

/// A steady climb is followed with a delay of the time constant, a step decays exponentially; exact at any rate.
TEST(Barometer, LagsByItsTimeConstant) {
  for (const double rate_hz : {2.0, 50.0}) {
    BarometerConfig c = perfect_barometer();
    c.lag_s = 0.7;
    c.rate_hz = rate_hz;
    Barometer climbing(c, 1);
    const auto height_m = [](double t_s) { return standard_height_m(101000.0 - 30.0 * t_s); };
    for (std::int64_t k = 0; static_cast<double>(k) < 20.0 * rate_hz; ++k) {
      const double t_s = static_cast<double>(k) / rate_hz;
      const auto r = climbing.sample(k, kStart + t_s, height_m(t_s));
      const double expected = 101000.0 - 30.0 * (t_s - c.lag_s * (1.0 - std::exp(-t_s / c.lag_s)));
      ASSERT_NEAR(r.message.pressure_pa, expected, 1e-6) << t_s;  // the height's round trip: 1e-8 m
    }
  }
}

TEST(Barometer, DriftAndNoiseHaveTheirSpreadAndAreInTheTruth) {
  BarometerConfig c;
  c.lag_s = 0.0;
  double drift2 = 0.0, noise2 = 0.0;
  const int runs = 2000;
  for (int run = 0; run < runs; ++run) {
    Barometer barometer(c, static_cast<std::uint64_t>(run));
    const auto r = barometer.sample(3000, kStart, 100.0);
    drift2 += r.truth.drift_pa * r.truth.drift_pa;
    noise2 += std::pow(r.message.pressure_pa - r.truth.pressure_pa - r.truth.drift_pa, 2);
  }
  EXPECT_NEAR(drift2 / runs / (100.0 * 100.0 + 50.0 * 50.0), 1.0, four_sigma_of_variance(runs));
  EXPECT_NEAR(noise2 / runs / (0.4 * 0.4 * 10.0), 1.0, four_sigma_of_variance(runs));
}

TEST(Barometer, RoundsToItsResolution) {
  BarometerConfig c = perfect_barometer();
  c.resolution_pa = 1.0;
  Barometer barometer(c, 1);
  const double p = barometer.sample(0, kStart, 123.0).message.pressure_pa;
  EXPECT_EQ(p, std::round(standard_pressure_pa(123.0)));
}

MagnetometerConfig perfect_magnetometer() {
  MagnetometerConfig c;
  c.hard_iron_ut = c.soft_iron_percent = c.noise_ut_per_sqrt_hz = 0.0;
  return c;
}

/// At Vicksburg the field points about 1 degree west of north and 61 degrees down: a level compass with the declination
/// given finds true heading.
TEST(Magnetometer, HeadingFollowsFromTheDeclination) {
  MagnetometerConfig c = perfect_magnetometer();
  c.declination_deg = -1.0;
  c.inclination_deg = 61.0;
  c.strength_ut = 48.0;
  const Magnetometer magnetometer(c, 1);
  EXPECT_NEAR(magnetometer.field_W_t().norm(), 48e-6, 1e-20);
  for (const double heading_deg : {0.0, 77.0, 180.0, 300.0}) {
    const double yaw_rad = (90.0 - heading_deg) * kDegree;
    const Eigen::Quaterniond R_WU(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
    const Eigen::Vector3d b = magnetometer.sample(0, kStart, R_WU).message.field_U_t;
    // U is x forward, y left: magnetic heading is the angle from the field's horizontal part to x, clockwise.
    const double magnetic_deg = std::atan2(b.y(), b.x()) / kDegree;
    EXPECT_NEAR(std::remainder(magnetic_deg + c.declination_deg - heading_deg, 360.0), 0.0, 1e-10);
    EXPECT_NEAR(b.z(), -48e-6 * std::sin(61.0 * kDegree), 1e-19);
  }
}

/// Turned all ways, readings without noise lie on an ellipsoid whose centre is the hard iron: opposite attitudes
/// average to it.
TEST(Magnetometer, IronShiftsAndDistorts) {
  MagnetometerConfig c = perfect_magnetometer();
  c.hard_iron_ut = 3.0;
  c.soft_iron_percent = 2.0;
  double hard2 = 0.0, soft2 = 0.0;
  const int units = 1000;
  for (int unit = 0; unit < units; ++unit) {
    const Magnetometer m(c, static_cast<std::uint64_t>(unit));
    const Eigen::Vector3d field = m.field_W_t();
    // Half a turn about an axis across the field turns the field round.
    const Eigen::Quaterniond across(Eigen::AngleAxisd(kPi, field.cross(Eigen::Vector3d::UnitX()).normalized()));
    const Eigen::Vector3d one = m.sample(0, kStart, Eigen::Quaterniond::Identity()).message.field_U_t;
    const Eigen::Vector3d other = m.sample(0, kStart, across).message.field_U_t;
    hard2 += (0.5 * (one + other)).squaredNorm();
    soft2 += (0.5 * (one - other) - field).squaredNorm();
  }
  EXPECT_NEAR(hard2 / (3 * units) / 9e-12, 1.0, four_sigma_of_variance(3 * units));
  // Three rows of the matrix times the field: the terms of each row are independent, those across rows are not; counted
  // as `units` normals.
  EXPECT_NEAR(soft2 / (3 * units) / std::pow(0.02 * 50e-6, 2), 1.0, four_sigma_of_variance(units));
}

TEST(Magnetometer, NoiseDependsOnItsSampleAlone) {
  const Magnetometer a(MagnetometerConfig{}, 5), b(MagnetometerConfig{}, 5);
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  (void)a.sample(3, kStart, level);
  EXPECT_EQ(a.sample(40, kStart, level).message.field_U_t, b.sample(40, kStart, level).message.field_U_t);
  EXPECT_NE(a.sample(41, kStart, level).message.field_U_t, b.sample(40, kStart, level).message.field_U_t);
}

/// States of a straight or circular drive that speeds up: speed v0 + a t, yaw rate w.
std::vector<KinematicState> drive_nodes(double t_s, double dt_s, double v0_m_s, double a_m_s2, double w_rad_s) {
  std::vector<KinematicState> nodes;
  for (int i = 0; i <= 4; ++i) {
    const double t = t_s + dt_s * i / 4.0;
    const double yaw_rad = w_rad_s * t, v_m_s = v0_m_s + a_m_s2 * t;
    KinematicState s;
    s.t = kStart + t;
    s.X_WB.R = Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
    s.v_WB_W = s.X_WB.R * Eigen::Vector3d(v_m_s, 0.0, 0.0);
    s.a_WB_W = s.X_WB.R * Eigen::Vector3d(a_m_s2, v_m_s * w_rad_s, 0.0);
    s.w_WB_B = {0.0, 0.0, w_rad_s};
    nodes.push_back(s);
  }
  return nodes;
}

OdometerConfig perfect_odometer() {
  OdometerConfig c;
  c.scale_percent = c.slip_percent = c.slip_percent_per_m_s2 = 0.0;
  return c;
}

/// Ticks add up to the distance of the wheel to within one tick, forwards and back; in a turn the inner wheel goes less
/// far.
TEST(Odometer, CountsTheDistanceOfItsWheel) {
  const OdometerConfig c = perfect_odometer();
  for (const double v_m_s : {5.0, -3.0, 0.004}) {
    for (const double w_rad_s : {0.0, 0.5}) {
      Odometer odometer(c, 1);
      std::int64_t ticks = 0;
      double distance_m = 0.0;
      for (std::int64_t k = 0; k < 1000; ++k) {
        const auto r =
            odometer.sample(k, drive_nodes(static_cast<double>(k) / c.rate_hz, 1.0 / c.rate_hz, v_m_s, 0.0, w_rad_s));
        ticks += r.message.ticks;
        distance_m += r.truth.distance_m;
        EXPECT_NEAR(r.message.speed_m_s * r.message.dt_s, static_cast<double>(r.message.ticks) * c.metres_per_tick,
                    1e-12);
      }
      EXPECT_NEAR(distance_m, 20.0 * (v_m_s - 0.8 * w_rad_s), 1e-9);
      EXPECT_LE(std::abs(static_cast<double>(ticks) - distance_m / c.metres_per_tick), 1.0);
    }
  }
}

/// What the wheel is pushed sideways it does not turn, nor rise: the same ticks to the bit.
TEST(Odometer, DoesNotSeeWhatIsAcrossItsWheel) {
  Odometer rolling(perfect_odometer(), 1), pushed(perfect_odometer(), 1);
  for (std::int64_t k = 0; k < 100; ++k) {
    const auto nodes = drive_nodes(static_cast<double>(k) / 50.0, 0.02, 5.0, 0.0, 0.0);
    auto across = nodes;
    for (KinematicState& node : across) node.v_WB_W += node.X_WB.R * Eigen::Vector3d(0.0, -0.4, 0.1);
    const auto a = rolling.sample(k, nodes), b = pushed.sample(k, across);
    ASSERT_EQ(a.message.ticks, b.message.ticks);
    ASSERT_EQ(a.truth.distance_m, b.truth.distance_m);
  }
}

/// Half a percent of slip per m/s^2: pulling away the wheel turns further than the vehicle goes, braking less.
TEST(Odometer, SlipsWithTraction) {
  OdometerConfig c = perfect_odometer();
  c.slip_percent_per_m_s2 = 0.5;
  c.metres_per_tick = 1e-5;
  for (const double a_m_s2 : {2.0, -2.0}) {
    Odometer odometer(c, 1);
    const auto r = odometer.sample(0, drive_nodes(0.0, 0.02, 10.0, a_m_s2, 0.0));
    EXPECT_NEAR(r.truth.slip, 0.005 * a_m_s2, 1e-12);
    EXPECT_NEAR(static_cast<double>(r.message.ticks) * 1e-5, r.truth.distance_m / (1.0 - r.truth.slip), 1e-5);
  }
}

TEST(Odometer, ScaleAndSlipHaveTheirSpread) {
  const OdometerConfig c = [] {
    OdometerConfig all;
    all.slip_percent_per_m_s2 = 0.0;
    return all;
  }();
  const int units = 2000;
  double scale2 = 0.0, slip2 = 0.0;
  for (int unit = 0; unit < units; ++unit) {
    Odometer odometer(c, static_cast<std::uint64_t>(unit));
    const auto r = odometer.sample(0, drive_nodes(0.0, 0.02, 10.0, 0.0, 0.0));
    scale2 += r.truth.scale_error * r.truth.scale_error;
    slip2 += r.truth.slip * r.truth.slip;
  }
  EXPECT_NEAR(scale2 / units / std::pow(0.005, 2), 1.0, four_sigma_of_variance(units));
  EXPECT_NEAR(slip2 / units / std::pow(0.002, 2), 1.0, four_sigma_of_variance(units));
}

TEST(Odometer, WantsItsSamplesInOrder) {
  Odometer odometer(OdometerConfig{}, 1);
  EXPECT_THROW(odometer.sample(1, drive_nodes(0.0, 0.02, 1.0, 0.0, 0.0)), ProgramError);
}

TEST(AidingConfig, IsReadFromTables) {
  const auto node = *ConfigNode::parse(
      "[magnetometer]\ndeclination_deg = 3.5\n[barometer]\nlag_s = 0.4\n[odometer]\nmetres_per_tik = 0.1\n",
      "aid.toml");
  MagnetometerConfig magnetometer;
  ASSERT_TRUE(read_config(node.find("magnetometer"), "magnetometer", magnetometer).ok());
  EXPECT_EQ(magnetometer.declination_deg, 3.5);
  BarometerConfig barometer;
  ASSERT_TRUE(read_config(node.find("barometer"), "barometer", barometer).ok());
  EXPECT_EQ(barometer.lag_s, 0.4);
  OdometerConfig odometer;
  const auto status = read_config(node.find("odometer"), "odometer", odometer);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().str().find("aid.toml:6: odometer.metres_per_tik"), std::string::npos)
      << status.error().str();
}

}  // namespace
}  // namespace canyon::inertial
