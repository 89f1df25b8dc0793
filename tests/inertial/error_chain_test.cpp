#include "canyon/inertial/error_chain.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/fusion/consistency.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/tests/inertial/smooth_path.h"
#include "canyon/tests/support/four_sigma.h"

namespace canyon::inertial {
namespace {

using canyon::testing::four_sigma_of_variance;

CatalogueEntry full_entry() {
  CatalogueEntry e = *load_catalogue_entry("stim300");
  e.gyro.in_run_bias_tau_s.value = 0.5;  // so that it moves within a short test
  e.accel.in_run_bias_tau_s.value = 0.5;
  return e;
}

ImuSample still_sample(double rate_hz) {
  ImuSample s;
  s.dt_s = 1.0 / rate_hz;
  s.dtheta_U = Eigen::Vector3d(0.1, -0.2, 0.3) * s.dt_s;
  s.dv_U = Eigen::Vector3d(0.5, -1.0, 9.8) * s.dt_s;
  return s;
}

ChainSetup setup(const CatalogueEntry& e, std::uint64_t seed, double rate_hz) {
  return {.entry = e, .seed = seed, .rate_hz = rate_hz, .leave_out = {}, .environment = {}};
}

/// What a chain adds to sample k of a constant motion.
ImuSample added(ErrorChain& chain, std::int64_t k, double rate_hz) {
  const ImuSample clean = still_sample(rate_hz);
  ImuSample s = clean;
  chain.corrupt(k, s);
  s.dtheta_U -= clean.dtheta_U;
  s.dv_U -= clean.dv_U;
  return s;
}

std::unique_ptr<ErrorChain> datasheet(const CatalogueEntry& e, std::uint64_t seed, double rate_hz = 100.0) {
  return *make_datasheet_chain(setup(e, seed, rate_hz));
}

/// Angle after t s of ARW: N sqrt(t); position after t s of VRW: N sqrt(t^3 / 3). At any sample rate.
TEST(ErrorChain, WhiteNoiseObeysItsLawAtAnyRate) {
  const CatalogueEntry entry = *load_catalogue_entry("high_grade_mems");
  const ImuNoise noise = entry.noise();
  const double t_s = 4.0;
  for (double rate_hz : {50.0, 200.0}) {
    const int runs = 400, samples = static_cast<int>(t_s * rate_hz);
    double angle2 = 0.0, position2 = 0.0;
    for (int run = 0; run < runs; ++run) {
      auto chain = *make_white_only_chain(setup(entry, static_cast<std::uint64_t>(run), rate_hz));
      Eigen::Vector3d angle = Eigen::Vector3d::Zero(), v = angle, p = angle;
      for (int k = 0; k < samples; ++k) {
        ImuSample s;
        s.dt_s = 1.0 / rate_hz;
        chain->corrupt(k, s);
        angle += s.dtheta_U;
        p += (v + 0.5 * s.dv_U) * s.dt_s;
        v += s.dv_U;
      }
      angle2 += angle.squaredNorm();
      position2 += p.squaredNorm();
    }
    const int n = 3 * runs;
    const double arw2 = noise.gyro.white_per_sqrt_hz * noise.gyro.white_per_sqrt_hz * t_s;
    const double vrw2 = noise.accel.white_per_sqrt_hz * noise.accel.white_per_sqrt_hz * t_s * t_s * t_s / 3.0;
    EXPECT_NEAR(angle2 / n / arw2, 1.0, four_sigma_of_variance(n)) << rate_hz;
    EXPECT_NEAR(position2 / n / vrw2, 1.0, four_sigma_of_variance(n)) << rate_hz;  // discretization: 1 / samples^2
  }
}

TEST(ErrorChain, SwitchingOneErrorOffShiftsNoOther) {
  const double rate_hz = 100.0;
  const CatalogueEntry all = full_entry();
  using Switch = void (*)(CatalogueEntry&, double factor);
  const Switch switches[] = {
      [](CatalogueEntry& e, double f) {
        e.gyro.arw_deg_per_sqrt_hr.value *= f, e.accel.vrw_m_s_per_sqrt_hr.value *= f;
      },
      [](CatalogueEntry& e, double f) {
        e.gyro.turn_on_bias_deg_per_hr.value *= f, e.accel.turn_on_bias_mg.value *= f;
      },
      [](CatalogueEntry& e, double f) { e.gyro.in_run_bias_deg_per_hr.value *= f, e.accel.in_run_bias_mg.value *= f; },
      [](CatalogueEntry& e, double f) { e.gyro.scale_ppm.value *= f, e.accel.scale_ppm.value *= f; },
      [](CatalogueEntry& e, double f) { e.gyro.misalignment_mrad.value *= f, e.accel.misalignment_mrad.value *= f; },
  };
  auto whole = datasheet(all, 5);
  std::vector<std::unique_ptr<ErrorChain>> alone;
  for (std::size_t one = 0; one < std::size(switches); ++one) {
    CatalogueEntry e = all;
    for (std::size_t other = 0; other < std::size(switches); ++other) {
      if (other != one) switches[other](e, 0.0);
    }
    alone.push_back(datasheet(e, 5));
  }
  for (int k = 0; k < 200; ++k) {
    const ImuSample total = added(*whole, k, rate_hz);
    Eigen::Vector3d dtheta = Eigen::Vector3d::Zero(), dv = Eigen::Vector3d::Zero();
    for (auto& chain : alone) {
      const ImuSample part = added(*chain, k, rate_hz);
      EXPECT_GT(part.dtheta_U.norm(), 0.0);
      EXPECT_GT(part.dv_U.norm(), 0.0);
      dtheta += part.dtheta_U;
      dv += part.dv_U;
    }
    const double eps = std::numeric_limits<double>::epsilon();
    ASSERT_LT((total.dtheta_U - dtheta).norm(), 32 * eps * 0.004) << k;
    ASSERT_LT((total.dv_U - dv).norm(), 32 * eps * 0.1) << k;
  }
}

TEST(ErrorChain, WhiteOnlyIsTheDatasheetsWhiteNoise) {
  CatalogueEntry e = full_entry();
  auto white_only = *make_white_only_chain(setup(e, 9, 100.0));
  GyroSheet gyro;
  gyro.arw_deg_per_sqrt_hr = e.gyro.arw_deg_per_sqrt_hr;
  AccelSheet accel;
  accel.vrw_m_s_per_sqrt_hr = e.accel.vrw_m_s_per_sqrt_hr;
  e.gyro = gyro;
  e.accel = accel;
  auto stripped = datasheet(e, 9);
  for (int k = 0; k < 50; ++k) {
    EXPECT_EQ(added(*white_only, k, 100.0).dtheta_U, added(*stripped, k, 100.0).dtheta_U);
    EXPECT_EQ(added(*white_only, k, 100.0).dv_U, added(*stripped, k, 100.0).dv_U);
  }
  EXPECT_EQ(white_only->noise().gyro.in_run_bias_tau_s, 1500.0);
  EXPECT_EQ(white_only->noise().gyro.in_run_bias_sigma, 0.0);
}

TEST(ErrorChain, ASampleDependsOnItsNumberNotOnTheWayThere) {
  for (const auto& row : error_chains()) {
    const CatalogueEntry e = *load_catalogue_entry("high_grade_mems");
    auto in_order = *row.make.make(setup(e, 3, 100.0));
    auto jumping = *row.make.make(setup(e, 3, 100.0));
    std::vector<ImuSample> samples;
    for (int k = 0; k < 60; ++k) samples.push_back(added(*in_order, k, 100.0));
    for (std::size_t k : {59u, 10u, 11u, 0u, 42u}) {
      const ImuSample s = added(*jumping, static_cast<std::int64_t>(k), 100.0);
      EXPECT_EQ(s.dtheta_U, samples[k].dtheta_U) << row.name << " " << k;
      EXPECT_EQ(s.dv_U, samples[k].dv_U) << row.name << " " << k;
    }
  }
}

TEST(ErrorChain, ConstantsHaveTheirSpread) {
  // Turn-on bias, scale and misalignment over many units, seen through a sample without white noise.
  CatalogueEntry e = full_entry();
  e.gyro.arw_deg_per_sqrt_hr.value = 0.0;
  e.gyro.in_run_bias_deg_per_hr.value = 0.0;
  const ImuNoise noise = e.noise();
  const int units = 500;
  double bias2 = 0.0, scale2 = 0.0, misalignment2 = 0.0;
  for (int unit = 0; unit < units; ++unit) {
    auto chain = datasheet(e, static_cast<std::uint64_t>(unit));
    ImuSample rest, turned;
    rest.dt_s = turned.dt_s = 0.01;
    turned.dtheta_U = {1.0, 0.0, 0.0};
    chain->corrupt(0, rest);
    chain->corrupt(0, turned);
    const Eigen::Vector3d column = turned.dtheta_U - rest.dtheta_U - Eigen::Vector3d::UnitX();
    bias2 += (rest.dtheta_U / 0.01).squaredNorm();
    scale2 += column.x() * column.x();
    misalignment2 += column.tail<2>().squaredNorm();
  }
  const auto ratio = [](double sum, int n, double sigma) { return sum / n / (sigma * sigma); };
  EXPECT_NEAR(ratio(bias2, 3 * units, noise.gyro.turn_on_bias_sigma), 1.0, four_sigma_of_variance(3 * units));
  EXPECT_NEAR(ratio(scale2, units, noise.gyro.scale_sigma), 1.0, four_sigma_of_variance(units));
  EXPECT_NEAR(ratio(misalignment2, 2 * units, noise.gyro.misalignment_sigma_rad), 1.0,
              four_sigma_of_variance(2 * units));
}

TEST(PaperChain, QuantizationTelescopes) {
  // The sum of n corrected quantization errors is one difference of two: bounded, not growing like white noise.
  CatalogueEntry e = *load_catalogue_entry("phidget_3_3_3");
  e.paper.gyro.white_process = e.paper.gyro.zero_offset = 0.0;
  e.paper.gyro.mass_kg = 1e-3;
  e.paper.gyro.drive_amplitude_m = 1e-3;  // thermal noise far below
  e.gyro.scale_ppm.value = 0.0;
  e.paper.gyro.quantization = 0.01;
  auto chain = *make_paper_chain(setup(e, 1, 125.0));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 20000; ++k) {
    ImuSample s;
    s.dt_s = 1.0 / 125.0;
    chain->corrupt(k, s);
    sum += s.dtheta_U;
    ASSERT_LT(sum.cwiseAbs().maxCoeff(), 2.0 * 6.0 * 0.01 * kDegree) << k;  // twice six sigma
  }
}

TEST(PaperChain, PrintedNoiseIsABiasTheCorrectedIsNot) {
  // "Normal distributions with means of sigma_T and sigma_quant": their means add up like a bias. Phidget set of
  // figure 7.
  CatalogueEntry e = *load_catalogue_entry("phidget_3_3_3");
  e.paper.gyro.zero_offset = e.paper.gyro.white_process = 0.0;
  e.gyro.scale_ppm.value = 0.0;
  auto printed = *make_paper_as_printed_chain(setup(e, 1, 125.0));
  auto corrected = *make_paper_chain(setup(e, 1, 125.0));
  double printed_sum = 0.0, corrected_sum = 0.0;
  const int n = 20000;
  for (int k = 0; k < n; ++k) {
    ImuSample a, b;
    a.dt_s = b.dt_s = 1.0 / 125.0;
    printed->corrupt(k, a);
    corrected->corrupt(k, b);
    printed_sum += a.dtheta_U.x() / a.dt_s;
    corrected_sum += b.dtheta_U.x() / b.dt_s;
  }
  const double quant = 0.01745 * std::sqrt(3.0 * 0.2 * 0.2 * 6.0);  // 0.0148, taken as rad/s: 51 deg/min
  EXPECT_NEAR(printed_sum / n, quant, 4.0 * quant / std::sqrt(n));
  EXPECT_LT(std::abs(corrected_sum / n), quant / 100.0);
}

TEST(PaperChain, NeedsItsParameters) {
  const auto no_table = make_paper_chain(setup(*load_catalogue_entry("stim300"), 1, 100.0));
  ASSERT_FALSE(no_table.ok());
  EXPECT_THAT(no_table.error().str(),
              ::testing::HasSubstr("\"stim300\" has no parameters for the paper's error chain"));
  CatalogueEntry e = *load_catalogue_entry("phidget_3_3_3");
  e.paper.correlation_time_s = 0.5;
  const auto diverging = make_paper_as_printed_chain(setup(e, 1, 125.0));
  ASSERT_FALSE(diverging.ok());
  EXPECT_EQ(diverging.error().str(),
            "paper.correlation_time_s: 0.5 s makes the printed recursion diverge, expected more than 1 s, or "
            "imu.errors = \"paper\"");
  EXPECT_TRUE(make_paper_chain(setup(e, 1, 125.0)).ok());
}

TEST(MakeImu, BuildsEveryChainAndTellsTheFilter) {
  const LocalFrame frame(Geodetic{0.56, -1.58, 60.0});
  const testing::SmoothPath path(GpsTime::from_week_sow(1590, 0.0));
  for (const std::string& name : model_names(error_chains())) {
    ImuConfig config;
    config.errors = name;
    const auto imu = make_imu(config, 1, frame);
    ASSERT_TRUE(imu.ok()) << imu.error().str();
    const ImuSample s = (*imu)->sample(0, path.nodes(0, 100.0, 4));
    EXPECT_TRUE(s.dtheta_U.allFinite() && s.dv_U.allFinite()) << name;
    if (name == "datasheet") {
      EXPECT_EQ((*imu)->noise().gyro.white_per_sqrt_hz, catalogue_noise("high_grade_mems")->gyro.white_per_sqrt_hz);
      EXPECT_EQ((*imu)->noise().accel.scale_sigma, catalogue_noise("high_grade_mems")->accel.scale_sigma);
    }
  }
  ImuConfig config;
  config.errors = "datashet";
  const auto misspelt = make_imu(config, 1, frame);
  ASSERT_FALSE(misspelt.ok());
  EXPECT_EQ(
      misspelt.error().str(),
      "imu.errors: unknown name \"datashet\", expected one of \"datasheet\", \"full\", \"physics\", \"white_only\", "
      "\"paper\", \"paper_as_printed\", \"none\"; nearest is \"datasheet\"");
}

}  // namespace
}  // namespace canyon::inertial
