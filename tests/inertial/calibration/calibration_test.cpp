#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/motion/rotation.h"
#include "canyon/core/random/random.h"
#include "canyon/core/units.h"
#include "canyon/inertial/allan/noise_terms.h"
#include "canyon/inertial/calibration/fitted_entry.h"
#include "canyon/inertial/calibration/resting_positions.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/tests/support/test_data.h"

namespace canyon::inertial {
namespace {

const Eigen::Matrix3d kGain = (Eigen::Matrix3d() << 0.01, 0.0, 0.0, 0.004, -0.02, 0.0, -0.003, 0.005, 0.015).finished();
const Eigen::Vector3d kBias(0.3, -0.2, 0.1);

Eigen::Vector3d measured(const Eigen::Vector3d& truth, double noise, std::uint64_t k) {
  return truth + kGain * truth + kBias + noise * RandomStream(2, "test.calibration").normal3(k);
}

// Known parameters come back within 4 sigma of what the fit itself says, 12 at a time: false alarm 8e-4.
TEST(Calibration, ToAReference) {
  std::vector<Eigen::Vector3d> truth, samples;
  for (std::uint64_t k = 0; k < 5000; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    truth.emplace_back(std::sin(t), std::cos(0.7 * t), 0.5 * std::sin(1.9 * t));
    samples.push_back(measured(truth.back(), 0.02, k));
  }
  const auto c = *fit_to_reference(samples, truth);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(c.bias[i], kBias[i], 4.0 * c.bias_sigma[i]);
    EXPECT_NEAR(c.bias_sigma[i], 0.02 / std::sqrt(5000.0), 1e-4);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(c.gain(i, j), kGain(i, j), 4.0 * c.gain_sigma(i, j)) << i << j;
  }
  EXPECT_NEAR(c.residual_rms, 0.02, 4.0 * 0.02 / std::sqrt(2.0 * 15000.0));
  EXPECT_LT((c.corrected(measured(truth[7], 0.0, 0)) - truth[7]).norm(), 0.01);
  // Motion about one axis shows nothing of the others.
  for (auto& y : truth) y = Eigen::Vector3d(y.x(), 0.0, 0.0);
  EXPECT_EQ(fit_to_reference(samples, truth).error().what, "the reference does not excite all three axes");
}

/// Eighteen ways to lay a unit down.
std::vector<Eigen::Vector3d> orientations() {
  std::vector<Eigen::Vector3d> out;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (std::abs(x) + std::abs(y) + std::abs(z) == 1 || std::abs(x) + std::abs(y) + std::abs(z) == 2)
          out.push_back(Eigen::Vector3d(x, y, z).normalized() * kStandardGravity);
  return out;
}

TEST(Calibration, ToGravityFromPositions) {
  if (!can_fit_noise()) GTEST_SKIP() << "built without CANYON_WITH_CERES";
  std::vector<Eigen::Vector3d> positions;
  for (const Eigen::Vector3d& f : orientations()) positions.push_back(measured(f, 1e-3, 100 + positions.size()));
  const auto c = *fit_to_gravity(positions, 1e-3, kStandardGravity);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(c.bias[i], kBias[i], 4.0 * c.bias_sigma[i]);
    EXPECT_LT(c.bias_sigma[i], 1e-3);
    for (int j = 0; j <= i; ++j) EXPECT_NEAR(c.gain(i, j), kGain(i, j), 4.0 * c.gain_sigma(i, j)) << i << j;
  }
  EXPECT_LT(c.residual_rms, 3e-3);
  EXPECT_GT(c.uncalibrated_rms, 0.1);
  positions.resize(8);
  EXPECT_EQ(fit_to_gravity(positions, 1e-3, kStandardGravity).error().what, "8 resting positions");
  // Nine times the same way up leaves nearly all of it open.
  const std::vector<Eigen::Vector3d> same(9, positions[0]);
  EXPECT_EQ(fit_to_gravity(same, 1e-3, kStandardGravity).error().what, "the 9 positions leave a parameter open");
}

/// A log of the positions: 5 s of rest each, 2 s of turning between them.
ImuLog turned_log() {
  ImuLog log;
  const RandomStream stream(8, "test.positions");
  const auto where = orientations();
  std::uint64_t k = 0;
  const auto add = [&](const Eigen::Vector3d& rate, const Eigen::Vector3d& force) {
    const Eigen::Vector3d f = force + kGain * force + kBias + 0.02 * stream.normal3(k, 0);
    const Eigen::Vector3d w = rate + Eigen::Vector3d(0.01, 0.02, -0.01) + 0.002 * stream.normal3(k, 1);
    log.t_s.push_back(0.01 * static_cast<double>(k++));
    for (std::size_t i = 0; i < 3; ++i) {
      log.channels[i].push_back(w[static_cast<Eigen::Index>(i)]);
      log.channels[3 + i].push_back(f[static_cast<Eigen::Index>(i)]);
    }
  };
  for (std::size_t p = 0; p < where.size(); ++p) {
    for (int i = 0; i < 500; ++i) add(Eigen::Vector3d::Zero(), where[p]);
    if (p + 1 == where.size()) break;
    for (int i = 0; i < 200; ++i) {
      const double share = i / 200.0;
      const Eigen::Vector3d way = (1.0 - share) * where[p] + share * where[p + 1];
      add(Eigen::Vector3d(0.3, 0.5, 0.8), way + Eigen::Vector3d(std::sin(0.3 * i), std::cos(0.2 * i), 0.5));
    }
  }
  return log;
}

TEST(Calibration, PositionsAreFoundInALog) {
  const auto found = resting_positions(turned_log());
  ASSERT_EQ(found.size(), orientations().size());
  for (std::size_t p = 0; p < found.size(); ++p) {
    const Eigen::Vector3d truth = orientations()[p];
    EXPECT_LT((found[p].force - (truth + kGain * truth + kBias)).norm(), 0.02) << p;
    EXPECT_LT((found[p].rate - Eigen::Vector3d(0.01, 0.02, -0.01)).norm(), 0.002) << p;
  }
}

/// A resting unit of a catalogue entry, all but its gravity.
ImuLog simulated(const CatalogueEntry& entry, std::size_t samples, double rate_hz, std::uint64_t seed) {
  auto chain = *make_full_chain({.entry = entry, .seed = seed, .rate_hz = rate_hz});
  std::vector<ImuSample> out(samples);
  for (ImuSample& s : out) s.dt_s = 1.0 / rate_hz;
  chain->corrupt_batch(0, out);
  ImuLog log;
  for (std::size_t k = 0; k < samples; ++k) {
    log.t_s.push_back(static_cast<double>(k) / rate_hz);
    for (std::size_t i = 0; i < 3; ++i) {
      log.channels[i].push_back(out[k].dtheta_U[static_cast<Eigen::Index>(i)] * rate_hz);
      log.channels[3 + i].push_back(out[k].dv_U[static_cast<Eigen::Index>(i)] * rate_hz);
    }
  }
  return log;
}

struct LoopShare {
  int inside = 0, points = 0;
  double share() const { return static_cast<double>(inside) / points; }
};
/// Gyroscope, accelerometer.
using LoopShares = std::array<LoopShare, 2>;

/// Fits an entry to a log, simulates it, and counts the points of each triad's curve (root mean square of its axes)
/// that agree within the 95 % band of two such logs. What shook the unit (sinusoids) is no figure of the unit; the
/// fit's own are added to the simulated curve.
LoopShares closed_loop(const ImuLog& log, const Sampling& sampling, const char* what) {
  FittedUnit unit;
  unit.noise = *log_noise(log, sampling, {});
  unit.name = "mine";
  unit.log = "log.csv";
  unit.rate_hz = 1.0 / sampling.interval_s;
  unit.duration_s = static_cast<double>(log.size()) * sampling.interval_s;
  unit.bias_source = {"test", "test"};
  const auto entry = parse_catalogue_entry(*catalogue_toml(unit), "mine.toml");
  EXPECT_TRUE(entry.ok());
  const ImuLog again = simulated(*entry, log.size(), unit.rate_hz, 77);
  const auto factors = averaging_factors(static_cast<std::int64_t>(log.size()), 4);
  LoopShares shares;
  for (std::size_t triad = 0; triad < 2; ++triad) {
    std::vector<double> before, after, edf;
    const NoiseFit fit = *fit_triad(unit, triad);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const ChannelNoise& n = unit.noise[3 * triad + axis];
      const auto curve = deviation("overlapping", again.channels[3 * triad + axis],
                                   {sampling.interval_s, {{0, again.size()}}, 0.0}, factors);
      before.resize(n.points.size());
      after.resize(n.points.size());
      edf.resize(n.points.size());
      for (std::size_t i = 0; i < n.points.size(); ++i) {
        before[i] += std::pow(n.points[i].deviation, 2);
        after[i] += std::pow(curve[i].deviation, 2);
        for (const int line : {kSinusoid, kSecondSinusoid, kThirdSinusoid}) {
          const FittedTerm& t = fit.term(kNoiseTermNames[line]);
          if (t.determined) after[i] += allan_variance(line, t.value, t.second, n.points[i].tau_s, sampling.interval_s);
        }
        edf[i] += std::min(n.points[i].edf, curve[i].edf);
      }
    }
    LoopShare& share = shares[triad];
    for (std::size_t i = 0; i < before.size(); ++i, ++share.points)
      // ln of a variance estimate spreads by sqrt(2 / edf); two of them.
      share.inside += std::abs(std::log(after[i] / before[i])) < 1.96 * std::sqrt(4.0 / edf[i]) ? 1 : 0;
  }
  std::printf("closed loop, %s: gyroscope %d of %d points within the 95 %% band, accelerometer %d of %d\n", what,
              shares[0].inside, shares[0].points, shares[1].inside, shares[1].points);
  return shares;
}

class ClosedLoopTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!can_fit_noise()) GTEST_SKIP() << "built without CANYON_WITH_CERES";
  }
};
class ClosedLoopRealTest : public ClosedLoopTest {};

TEST_F(ClosedLoopTest, OfASimulatedUnit) {
  CatalogueEntry e = *load_catalogue_entry("adis16405");
  e.gyro.resolution_deg_per_s.value = e.accel.resolution_mg.value = 0.0;
  const ImuLog log = simulated(e, 180000, 100.0, 5);
  const LoopShares shares = closed_loop(log, {0.01, {{0, log.size()}}, 0.0}, "simulated ADIS16405");
  EXPECT_GE(shares[0].share(), 0.9);
  EXPECT_GE(shares[1].share(), 0.9);
}

TEST_F(ClosedLoopRealTest, OfAnAdis16405) {
  CANYON_REAL_DATA(path, "inertial/allan_adis16405/adis16405_imu1_first30min_100hz.i16");
  const std::string bytes = *read_text_file(path);
  std::vector<std::int16_t> counts(bytes.size() / 2);
  std::memcpy(counts.data(), bytes.data(), bytes.size());
  ImuLog log;
  for (std::size_t k = 0; k < counts.size() / 6; ++k) {
    log.t_s.push_back(0.01 * static_cast<double>(k));
    for (std::size_t c = 0; c < 6; ++c)
      log.channels[c].push_back(counts[6 * k + c] * (c < 3 ? 0.05 * kDegree : 0.00333 * kStandardGravity));
  }
  const LoopShares shares = closed_loop(log, {0.01, {{0, log.size()}}, 0.0}, "real ADIS16405");
  EXPECT_GE(shares[0].share(), 0.9);
  EXPECT_GE(shares[1].share(), 0.9);
}

TEST_F(ClosedLoopRealTest, OfAnMpu6050) {
  CANYON_REAL_DATA(path, "inertial/allan_mpu6050/mpu6050_static_655s.csv");
  const auto log = read_imu_log(path, {"t_us,ax_g*2.44140625e-4,ay_g*2.44140625e-4,az_g*2.44140625e-4,"
                                       "gx_deg_s*0.00763358779,gy_deg_s*0.00763358779,gz_deg_s*0.00763358779"});
  ASSERT_TRUE(log.ok()) << log.error().str();
  const LoopShares shares = closed_loop(*log, sampling_of(log->t_s), "real MPU-6050");
  EXPECT_GE(shares[0].share(), 0.9);
  EXPECT_GE(shares[1].share(), 0.9);
}

/// The motion of a rate table and a shaker, about and along all axes.
void move(std::size_t k, Eigen::Vector3d& rate, Eigen::Vector3d& force) {
  const double t = 0.01 * static_cast<double>(k);
  rate = {std::sin(0.9 * t), std::cos(0.7 * t), 0.8 * std::sin(1.9 * t)};
  force = {3.0 * std::sin(1.3 * t), 4.0 * std::cos(0.4 * t), kStandardGravity + 2.0 * std::sin(2.7 * t)};
}

/// What a unit of the entry measures of that motion; the seed draws its constants.
std::array<std::vector<Eigen::Vector3d>, 2> measured_motion(const CatalogueEntry& entry, std::uint64_t seed,
                                                            std::size_t samples) {
  auto chain = *make_full_chain({.entry = entry, .seed = seed, .rate_hz = 100.0});
  std::array<std::vector<Eigen::Vector3d>, 2> out;
  for (std::size_t k = 0; k < samples; ++k) {
    ImuSample s;
    Eigen::Vector3d rate, force;
    move(k, rate, force);
    s.dt_s = 0.01;
    s.dtheta_U = 0.01 * rate;
    s.dv_U = 0.01 * force;
    chain->corrupt(static_cast<std::int64_t>(k), s);
    out[0].push_back(s.dtheta_U / 0.01);
    out[1].push_back(s.dv_U / 0.01);
  }
  return out;
}

/// Calibrated against the motion itself.
std::array<TriadCalibration, 2> calibrated(const CatalogueEntry& entry, std::uint64_t seed, std::size_t samples) {
  const auto measured = measured_motion(entry, seed, samples);
  std::array<std::vector<Eigen::Vector3d>, 2> truth;
  for (std::size_t k = 0; k < samples; ++k) {
    Eigen::Vector3d rate, force;
    move(k, rate, force);
    truth[0].push_back(rate);
    truth[1].push_back(force);
  }
  return {*fit_to_reference(measured[0], truth[0]), *fit_to_reference(measured[1], truth[1])};
}

double root_mean_square_of(const Eigen::Matrix3d& m, bool diagonal) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += (i == j) == diagonal ? m(i, j) * m(i, j) : 0.0;
  return std::sqrt(sum / (diagonal ? 3.0 : 6.0));
}

// A unit of known scale factors, misalignments and biases, calibrated and written as an entry: the entry's figures are
// the root mean squares of what the unit had, and units simulated from the entry have such again: over 60 of them the
// root mean square of 3 (6) terms each is the entry's within four standard deviations, 1 / sqrt(2 * 180) each.
TEST_F(ClosedLoopTest, ACalibratedEntryHoldsScaleMisalignmentAndBias) {
  CatalogueEntry unit = *load_catalogue_entry("mpu6050");
  unit.gyro.nonlinearity_percent.value = unit.accel.nonlinearity_percent.value = 0.0;
  unit.gyro.g_sensitivity_deg_per_hr_per_g.value = 0.0;
  unit.gyro.resolution_deg_per_s.value = unit.accel.resolution_mg.value = 0.0;
  const std::size_t samples = 20000;
  const auto found = calibrated(unit, 11, samples);
  FittedUnit fitted;
  fitted.name = "mine";
  fitted.log = "log.csv";
  fitted.rate_hz = 100.0;
  fitted.duration_s = 200.0;
  const ImuLog rest = simulated(unit, samples, 100.0, 11);
  fitted.noise = *log_noise(rest, {0.01, {{0, samples}}, 0.0}, {});
  for (std::size_t triad = 0; triad < 2; ++triad)
    take_calibration(fitted, triad, found[triad], "found in log.csv against the reference truth.csv");
  const std::string toml = *catalogue_toml(fitted);
  EXPECT_NE(
      toml.find("scale_source = \"found in log.csv against the reference truth.csv, root mean square of the axes\""),
      std::string::npos)
      << toml;
  const auto entry = parse_catalogue_entry(toml, "mine.toml");
  ASSERT_TRUE(entry.ok()) << entry.error().str();
  const UnitFigures figures = entry->figures();
  const TriadFigures* triads[2] = {&figures.gyro, &figures.accel};
  for (std::size_t triad = 0; triad < 2; ++triad) {
    const double scale = root_mean_square_of(found[triad].gain, true);
    const double tilt = root_mean_square_of(found[triad].gain, false);
    EXPECT_GT(scale, 1e-3);
    EXPECT_NEAR(triads[triad]->scale / scale, 1.0, 1e-5);
    EXPECT_NEAR(triads[triad]->misalignment_rad / tilt, 1.0, 1e-5);
    EXPECT_NEAR(triads[triad]->turn_on_bias / (found[triad].bias.norm() / std::sqrt(3.0)), 1.0, 1e-5);
  }
  // What the unit had, from its own entry: 1 % and 20 mrad are the sigmas that the seed draws from.
  EXPECT_LT(triads[0]->scale, 4.0 * 0.01);
  double scale2[2] = {}, tilt2[2] = {}, bias2[2] = {};
  constexpr int kUnits = 60;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const auto again = calibrated(*entry, 100 + seed, 2000);
    for (std::size_t triad = 0; triad < 2; ++triad) {
      scale2[triad] += std::pow(root_mean_square_of(again[triad].gain, true), 2) / kUnits;
      tilt2[triad] += std::pow(root_mean_square_of(again[triad].gain, false), 2) / kUnits;
      bias2[triad] += again[triad].bias.squaredNorm() / 3.0 / kUnits;
    }
  }
  for (std::size_t triad = 0; triad < 2; ++triad) {
    EXPECT_NEAR(std::sqrt(scale2[triad]) / triads[triad]->scale, 1.0, 4.0 / std::sqrt(2.0 * 180.0)) << triad;
    EXPECT_NEAR(std::sqrt(tilt2[triad]) / triads[triad]->misalignment_rad, 1.0, 4.0 / std::sqrt(2.0 * 360.0)) << triad;
    EXPECT_NEAR(std::sqrt(bias2[triad]) / triads[triad]->turn_on_bias, 1.0, 4.0 / std::sqrt(2.0 * 180.0)) << triad;
  }
}

TEST_F(ClosedLoopTest, TheEntrySaysWhereItsFiguresAreFrom) {
  const ImuLog log = simulated(*load_catalogue_entry("stim300"), 20000, 100.0, 5);
  FittedUnit unit;
  unit.noise = *log_noise(log, {0.01, {{0, log.size()}}, 0.0}, {});
  unit.name = "my \"unit\"";
  unit.log = "log.csv";
  unit.duration_s = 200.0;
  unit.rate_hz = 100.0;
  unit.bias = {1e-5, 0.01};
  unit.bias_source = {"mean rate", "mean force"};
  const std::string toml = *catalogue_toml(unit);
  EXPECT_NE(
      toml.find("arw_source = \"fitted to the Allan deviation of log.csv, 200 s at 100 Hz, root mean square of the "
                "axes\""),
      std::string::npos)
      << toml;
  EXPECT_NE(toml.find("scale_ppm = 0.0\nscale_source = \"a resting log does not show it\""), std::string::npos);
  const auto entry = parse_catalogue_entry(toml, "mine.toml");
  ASSERT_TRUE(entry.ok()) << entry.error().str();
  EXPECT_EQ(entry->name, "my \"unit\"");
  EXPECT_NEAR(entry->noise().gyro.white_per_sqrt_hz / load_catalogue_entry("stim300")->noise().gyro.white_per_sqrt_hz,
              1.0, 0.03);
  EXPECT_NEAR(entry->noise().accel.turn_on_bias_sigma, 0.01, 1e-7);
}

}  // namespace
}  // namespace canyon::inertial
