#include "canyon/inertial/errors/error_link.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/inertial/error_chain.h"
#include "canyon/inertial/imu_model.h"
#include "canyon/tests/inertial/every_link.h"

namespace canyon::inertial {
namespace {

constexpr double kRate_hz = 100.0, kDt_s = 1.0 / kRate_hz;
constexpr double kEps = std::numeric_limits<double>::epsilon();

/// A chain of the links named alone, of the unit that has every error.
std::unique_ptr<ErrorChain> only(const std::vector<std::string>& names, CatalogueEntry entry = testing::every_link(),
                                 std::uint64_t seed = 4) {
  ChainSetup setup{
      .entry = entry, .seed = seed, .rate_hz = kRate_hz, .leave_out = {}, .environment = testing::warming_up()};
  for (const std::string& name : model_names(error_links())) {
    if (std::find(names.begin(), names.end(), name) == names.end()) setup.leave_out.push_back(name);
  }
  return *make_error_chain("full", setup);
}

ImuSample moving(const Eigen::Vector3d& rate, const Eigen::Vector3d& force) {
  ImuSample s;
  s.dt_s = kDt_s;
  s.dtheta_U = rate * kDt_s;
  s.dv_U = force * kDt_s;
  return s;
}

/// A motion that changes from sample to sample.
ImuSample sample_of_motion(std::int64_t k) {
  const double t = static_cast<double>(k) * kDt_s;
  ImuSample s = moving({0.3 * std::sin(t), -0.5 * std::cos(0.7 * t), 1.0 + t * 0.01},
                       {2.0 * std::cos(t), -1.0 + std::sin(3.0 * t), 9.8 + 0.1 * std::sin(20.0 * t)});
  s.t = tick(GpsTime{1'000'000'000'000}, k + 1, kRate_hz);
  return s;
}

std::vector<ImuSample> motion(std::int64_t first, std::int64_t count) {
  std::vector<ImuSample> samples;
  for (std::int64_t k = first; k < first + count; ++k) samples.push_back(sample_of_motion(k));
  return samples;
}

/// Mean error of the rate and the specific force that a chain gives a constant motion.
ImuSample error_at(ErrorChain& chain, std::int64_t k, const Eigen::Vector3d& rate, const Eigen::Vector3d& force) {
  ImuSample s = moving(rate, force);
  chain.corrupt(k, s);
  s.dtheta_U = s.dtheta_U / kDt_s - rate;
  s.dv_U = s.dv_U / kDt_s - force;
  return s;
}

void expect_same(const ImuSample& a, const ImuSample& b, std::int64_t k) {
  ASSERT_EQ(a.dtheta_U, b.dtheta_U) << k;
  ASSERT_EQ(a.dv_U, b.dv_U) << k;
  ASSERT_EQ(a.t.ns, b.t.ns) << k;
  ASSERT_EQ(a.dt_s, b.dt_s) << k;
  ASSERT_EQ(a.lost, b.lost) << k;
}

TEST(ErrorLinks, EveryNameHasALinkInTheFullChain) {
  for (const std::string& name : model_names(error_links())) {
    auto chain = only({name});
    std::vector<ImuSample> samples = motion(0, 400);
    chain->corrupt_batch(0, samples);
    bool changed = false;
    for (std::int64_t k = 0; k < 400; ++k) {
      const ImuSample clean = sample_of_motion(k), &s = samples[static_cast<std::size_t>(k)];
      changed |= s.dtheta_U != clean.dtheta_U || s.dv_U != clean.dv_U || s.t.ns != clean.t.ns;
    }
    EXPECT_EQ(changed, name != "saturation") << name;  // the motion stays within the range
  }
}

TEST(ErrorLinks, BatchesEqualSingleSamplesToTheBit) {
  const CatalogueEntry entry = testing::every_link();
  const ChainSetup setup{
      .entry = entry, .seed = 8, .rate_hz = kRate_hz, .leave_out = {}, .environment = testing::warming_up()};
  auto one_by_one = *make_full_chain(setup), at_once = *make_full_chain(setup), in_pieces = *make_full_chain(setup);
  const std::int64_t count = 1500;
  std::vector<ImuSample> single = motion(0, count), batch = single, pieces = single;
  for (std::int64_t k = 0; k < count; ++k) one_by_one->corrupt(k, single[static_cast<std::size_t>(k)]);
  at_once->corrupt_batch(0, batch);
  std::int64_t first = 0;
  for (const std::size_t length : {1u, 255u, 2u, 600u, 511u, 131u}) {
    in_pieces->corrupt_batch(first, std::span(pieces).subspan(static_cast<std::size_t>(first), length));
    first += static_cast<std::int64_t>(length);
  }
  ASSERT_EQ(first, count);
  for (std::int64_t k = 0; k < count; ++k) {
    expect_same(batch[static_cast<std::size_t>(k)], single[static_cast<std::size_t>(k)], k);
    expect_same(pieces[static_cast<std::size_t>(k)], single[static_cast<std::size_t>(k)], k);
  }
}

/// A shard with a chain of its own, after the few samples that latency and losses look back on, is that part of the
/// run.
TEST(ErrorLinks, ShardsMakeTheSameRun) {
  const ChainSetup setup{.entry = testing::every_link(),
                         .seed = 8,
                         .rate_hz = kRate_hz,
                         .leave_out = {},
                         .environment = testing::warming_up()};
  auto chain = *make_full_chain(setup);
  const std::int64_t count = 4000, memory = chain->memory();
  EXPECT_EQ(memory, 2 + 4);  // 12 ms at 100 Hz; losses of three
  std::vector<ImuSample> whole = motion(0, count);
  chain->corrupt_batch(0, whole);
  int begins_within_a_loss = 0;
  for (std::int64_t first = 5; first + 40 < count; first += 61) {
    auto shard = *make_full_chain(setup);
    const std::int64_t from = std::max<std::int64_t>(0, first - memory);
    std::vector<ImuSample> samples = motion(from, first + 40 - from);
    shard->corrupt_batch(from, samples);
    begins_within_a_loss += whole[static_cast<std::size_t>(first)].lost;
    for (std::int64_t k = first; k < first + 40; ++k) {
      expect_same(samples[static_cast<std::size_t>(k - from)], whole[static_cast<std::size_t>(k)], k);
    }
  }
  EXPECT_GT(begins_within_a_loss, 0);
  EXPECT_EQ((*make_datasheet_chain(setup))->memory(), 0);
}

/// Links of the elements add up: their sum is the sum of each alone (rounding: 32 eps of the increment).
TEST(ErrorLinks, ElementLinksAddUp) {
  std::vector<std::string> element;
  for (const std::string& name : model_names(error_links())) {
    if (name == "cross_talk") break;
    if (name != "latency") element.push_back(name);
  }
  auto together = only(element);
  std::vector<std::unique_ptr<ErrorChain>> alone;
  for (const std::string& name : element) alone.push_back(only({name}));
  for (std::int64_t k = 0; k < 600; k += 7) {
    const ImuSample clean = sample_of_motion(k);
    ImuSample sum = clean, all = clean;
    together->corrupt(k, all);
    for (auto& chain : alone) {
      ImuSample part = clean;
      chain->corrupt(k, part);
      sum.dtheta_U += part.dtheta_U - clean.dtheta_U;
      sum.dv_U += part.dv_U - clean.dv_U;
    }
    ASSERT_LT((all.dtheta_U - sum.dtheta_U).norm(), 32 * kEps * clean.dtheta_U.norm()) << k;
    ASSERT_LT((all.dv_U - sum.dv_U).norm(), 32 * kEps * clean.dv_U.norm()) << k;
  }
}

TEST(ErrorLinks, TurnOnBiasIsConstant) {
  auto chain = only({"turn_on_bias"});
  const Eigen::Vector3d rate(0.1, 0.2, 0.3), force(1.0, 2.0, 9.0);
  const ImuSample at_start = error_at(*chain, 0, rate, force), later = error_at(*chain, 99999, -rate, force);
  EXPECT_LT((at_start.dtheta_U - later.dtheta_U).norm(), 16 * kEps * rate.norm());
  EXPECT_GT(at_start.dtheta_U.norm(), 10.0 * kDegree / kHour);  // 100 deg/h
}

TEST(ErrorLinks, AsymmetryIsEvenScaleIsOdd) {
  const Eigen::Vector3d rate(0.7, -0.2, 1.3), zero = Eigen::Vector3d::Zero();
  auto scale = only({"scale_factor"}), asymmetry = only({"scale_asymmetry"});
  EXPECT_EQ(error_at(*scale, 0, rate, zero).dtheta_U, -error_at(*scale, 0, -rate, zero).dtheta_U);
  const Eigen::Vector3d up = error_at(*asymmetry, 0, rate, zero).dtheta_U;
  const Eigen::Vector3d down = error_at(*asymmetry, 0, -rate, zero).dtheta_U;
  EXPECT_LT((up - down).norm(), 16 * kEps * rate.norm());
  EXPECT_GT(up.norm(), 1e-5);
}

/// The spread of the worst distance from the best straight line, over many units, is that of the figure: for the cubic
/// alone it is range times figure / sqrt 2 times a unit normal.
TEST(ErrorLinks, NonlinearityLeavesTheStraightLineByItsFigure) {
  const CatalogueEntry e = testing::every_link();
  const double range = e.figures().gyro.range, figure = e.figures().gyro.nonlinearity;
  const int units = 400;
  double cubic2 = 0.0, even2 = 0.0;
  for (int unit = 0; unit < units; ++unit) {
    auto chain = only({"nonlinearity"}, e, static_cast<std::uint64_t>(unit));
    const auto error = [&](double part) {
      return error_at(*chain, 0, Eigen::Vector3d::Constant(part * range), Eigen::Vector3d::Zero()).dtheta_U;
    };
    // At the end of the range and at its half the Chebyshev cubic is +1 and -1.
    const Eigen::Vector3d odd_end = 0.5 * (error(1.0) - error(-1.0)), odd_half = 0.5 * (error(0.5) - error(-0.5));
    EXPECT_LT((odd_end + odd_half).norm(), 64 * kEps * range);
    cubic2 += odd_end.squaredNorm();
    even2 += (0.5 * (error(1.0) + error(-1.0))).squaredNorm();
  }
  const double one2 = 0.5 * range * range * figure * figure;
  EXPECT_NEAR(cubic2 / (3 * units) / one2, 1.0, 4.0 * std::sqrt(2.0 / (3 * units)));  // false alarm 6e-5
  EXPECT_NEAR(even2 / (3 * units) / (4.0 * one2), 1.0, 4.0 * std::sqrt(2.0 / (3 * units)));
}

TEST(ErrorLinks, PackageMisalignmentIsARotation) {
  auto chain = only({"package_misalignment"});
  const Eigen::Vector3d rate(0.7, -0.2, 1.3), force(1.0, -4.0, 9.0);
  ImuSample s = moving(rate, force);
  chain->corrupt(0, s);
  EXPECT_NEAR(s.dtheta_U.norm(), (rate * kDt_s).norm(), 8 * kEps * rate.norm() * kDt_s);
  EXPECT_NEAR(s.dv_U.norm(), (force * kDt_s).norm(), 8 * kEps * force.norm() * kDt_s);
  EXPECT_GT((s.dtheta_U - rate * kDt_s).norm(), 1e-3 * kDt_s);
}

TEST(ErrorLinks, SpecificForceReachesTheGyroscope) {
  auto chain = only({"g_sensitivity"});
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), force(3.0, -4.0, 9.0);
  EXPECT_EQ(error_at(*chain, 0, zero, zero).dtheta_U, zero);
  const Eigen::Vector3d once = error_at(*chain, 0, zero, force).dtheta_U;
  const Eigen::Vector3d twice = error_at(*chain, 0, zero, 2.0 * force).dtheta_U;
  EXPECT_LT((twice - 2.0 * once).norm(), 16 * kEps * once.norm());
  EXPECT_GT(once.norm(), 1.0 * kDegree / kHour);  // 30 deg/h/g under one g
  EXPECT_EQ(error_at(*chain, 0, zero, force).dv_U, zero);
}

/// The profile is 15, 40, 45 deg C at 0, 600, 1200 s, the reference 25: the bias is zero at 240 s and changes sign
/// there.
TEST(ErrorLinks, TemperatureProfileInBiasAndScaleOut) {
  auto chain = only({"temperature"});
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), rate(1.0, 1.0, 1.0);
  const auto bias = [&](double t_s) { return error_at(*chain, std::llround(t_s * kRate_hz), zero, zero).dtheta_U; };
  const Eigen::Vector3d cold = bias(0.0), hot = bias(1e4);
  EXPECT_GT(cold.norm(), 10.0 * kDegree / kHour);
  EXPECT_LT((hot + 2.0 * cold).norm(), 1e-3 * cold.norm());  // +20 K and -10 K; half a sample into the profile 2e-5
  EXPECT_LT((bias(600.0) + 1.5 * cold).norm(), 1e-3 * cold.norm());
  EXPECT_LT(bias(240.0).norm(), 1e-3 * cold.norm());
  const Eigen::Vector3d gain = error_at(*chain, 1'000'000, rate, zero).dtheta_U - hot;
  EXPECT_GT(gain.norm(), 1e-4);  // 40 ppm/K at 20 K
  EXPECT_LT(gain.norm(), 1e-2);
}

TEST(ErrorLinks, VibrationIsRectifiedByItsMeanSquare) {
  auto chain = only({"vibration_rectification"});
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const ImuSample error = error_at(*chain, 0, zero, zero);
  const double g2 = kStandardGravity * kStandardGravity;
  EXPECT_NEAR(std::abs(error.dv_U.x()) / (0.05 * kMilliG * 25.0 / g2), 1.0, 8 * kEps);
  EXPECT_NEAR(std::abs(error.dv_U.z()) / (0.05 * kMilliG * 100.0 / g2), 1.0, 8 * kEps);
  EXPECT_NEAR(std::abs(error.dtheta_U.y()) / (kDegree / kHour * 150.0 / g2), 1.0, 8 * kEps);
}

TEST(ErrorLinks, QuantizationNoiseTelescopes) {
  auto chain = only({"quantization_noise"});
  std::vector<ImuSample> samples(20000);
  for (ImuSample& s : samples) s.dt_s = kDt_s;
  chain->corrupt_batch(0, samples);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double square = 0.0;
  for (const ImuSample& s : samples) {
    sum += s.dtheta_U;
    square += s.dtheta_U.squaredNorm();
    ASSERT_LT(sum.cwiseAbs().maxCoeff(), 2.0 * 6.0 * 1e-4 * kDegree);  // twice six sigma of Q
  }
  // Differences of neighbours: variance 2 Q^2, and of its estimate 24 / n of the square; false alarm 6e-5.
  EXPECT_NEAR(square / 60000 / (2.0 * std::pow(1e-4 * kDegree, 2)), 1.0, 4.0 * std::sqrt(3.0 / 60000));
}

TEST(ErrorLinks, OutputStageRoundsClampsAndKillsSmallOutputs) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const double range = 450.0 * kDegree, step = 0.00625 * kDegree, dead = 1e-3 * kDegree;
  auto saturation = only({"saturation"}), quantization = only({"quantization"}), dead_band = only({"dead_band"});
  ImuSample s = moving({1.1 * range, -3.0 * range, 0.5 * range}, zero);
  saturation->corrupt(0, s);
  EXPECT_NEAR(s.dtheta_U.x(), range * kDt_s, 2 * kEps * range);
  EXPECT_NEAR(s.dtheta_U.y(), -range * kDt_s, 2 * kEps * range);
  EXPECT_EQ(s.dtheta_U.z(), 0.5 * range * kDt_s);

  s = moving({1.4 * step, -1.6 * step, 0.4 * step}, zero);
  quantization->corrupt(0, s);
  EXPECT_NEAR(s.dtheta_U.x(), step * kDt_s, 4 * kEps * step);
  EXPECT_NEAR(s.dtheta_U.y(), -2.0 * step * kDt_s, 4 * kEps * step);
  EXPECT_EQ(s.dtheta_U.z(), 0.0);

  s = moving({0.9 * dead, -0.9 * dead, 1.1 * dead}, zero);
  const double kept = s.dtheta_U.z();
  dead_band->corrupt(0, s);
  EXPECT_EQ(s.dtheta_U, Eigen::Vector3d(0.0, 0.0, kept));
}

TEST(ErrorLinks, CrossTalkMixesWhatTheElementsGive) {
  auto bias = only({"turn_on_bias"}), both = only({"turn_on_bias", "cross_talk"});
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d b = error_at(*bias, 0, zero, zero).dtheta_U;
  const Eigen::Vector3d leak = error_at(*both, 0, zero, zero).dtheta_U - b;
  EXPECT_GT(leak.norm(), 1e-4 * b.norm());
  EXPECT_LT(leak.norm(), 0.1 * b.norm());  // 0.5 % each
}

/// Twelve milliseconds at 10 ms: 0.8 of the sample before and 0.2 of the one before that.
TEST(ErrorLinks, LatencyShowsTheMotionBefore) {
  auto chain = only({"latency"});
  for (std::int64_t k = 0; k < 600; ++k) {
    ImuSample s = sample_of_motion(k);
    chain->corrupt(k, s);
    if (k < 2) continue;
    const Eigen::Vector3d expected = 0.8 * sample_of_motion(k - 1).dtheta_U + 0.2 * sample_of_motion(k - 2).dtheta_U;
    ASSERT_LT((s.dtheta_U - expected).norm(), 16 * kEps * expected.norm()) << k;
  }
}

TEST(ErrorLinks, LossesRepeatTheLastSampleThatCame) {
  auto chain = only({"losses"});
  const int count = 60000;
  int lost = 0, run = 0, longest = 0;
  ImuSample last;
  for (int k = 0; k < count; ++k) {
    ImuSample s = sample_of_motion(k);
    const GpsTime t = s.t;
    chain->corrupt(k, s);
    EXPECT_EQ(s.t.ns, t.ns);
    run = s.lost ? run + 1 : 0;
    longest = std::max(longest, run);
    lost += s.lost;
    if (s.lost) {
      ASSERT_EQ(s.dtheta_U, last.dtheta_U) << k;
      ASSERT_EQ(s.dv_U, last.dv_U) << k;
    } else {
      ASSERT_EQ(s.dtheta_U, sample_of_motion(k).dtheta_U) << k;
      last = s;
    }
  }
  EXPECT_EQ(longest, 3);
  // Groups of three; neighbours exclude one another, so the count spreads less than a binomial's. False alarm 6e-5.
  const double groups = count / 3.0;
  EXPECT_NEAR(lost / 3.0, 0.02 * groups, 4.0 * std::sqrt(0.02 * groups));
}

TEST(ErrorLinks, ClockStampsDriftAndJitter) {
  auto chain = only({"clock"});
  double jitter2 = 0.0, dt_sum = 0.0;
  const std::int64_t count = 20000;
  std::vector<double> offsets;
  for (std::int64_t k = 0; k < count; ++k) {
    ImuSample s = sample_of_motion(k);
    chain->corrupt(k, s);
    offsets.push_back(s.t - sample_of_motion(k).t);
    dt_sum += s.dt_s;
    ASSERT_EQ(s.dtheta_U, sample_of_motion(k).dtheta_U);
    // The interval is the difference of the stamps (which are whole nanoseconds).
    if (k > 0) {
      const double change = offsets.back() - offsets[offsets.size() - 2];
      ASSERT_NEAR(s.dt_s - kDt_s, change, 1.5e-9) << k;
    }
  }
  // The straight line through the offsets: its slope is the skew, what is left the jitter.
  const double n = static_cast<double>(count), middle = 0.5 * (n - 1.0);
  double mean = 0.0, slope = 0.0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    mean += offsets[i] / n;
    slope += (static_cast<double>(i) - middle) * offsets[i] * 12.0 / (n * (n * n - 1.0));
  }
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double residual = offsets[i] - mean - slope * (static_cast<double>(i) - middle);
    jitter2 += residual * residual / n;
  }
  const double skew = slope / kDt_s;
  EXPECT_LT(std::abs(skew), 5.0 * 20e-6);
  EXPECT_GT(std::abs(skew), 1e-7);
  EXPECT_NEAR(jitter2 / (50e-6 * 50e-6), 1.0, 4.0 * std::sqrt(2.0 / n));  // false alarm 6e-5
  EXPECT_NEAR(dt_sum, n * (kDt_s + skew * kDt_s), 6.0 * 2.0 * 50e-6);     // the first stamp's and the last one's
}

TEST(ErrorLinks, FlickerStandsForTheInRunBiasUnlessTheyAreTwo) {
  CatalogueEntry e = testing::every_link();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  auto both = only({"in_run_bias", "flicker"}, e), flicker = only({"flicker"}, e);
  EXPECT_NE(error_at(*both, 5, zero, zero).dtheta_U, error_at(*flicker, 5, zero, zero).dtheta_U);
  e.in_run_bias_is_instability = true;
  auto same_floor = only({"in_run_bias", "flicker"}, e);
  EXPECT_EQ(error_at(*same_floor, 5, zero, zero).dtheta_U, error_at(*flicker, 5, zero, zero).dtheta_U);
}

TEST(ErrorLinks, TheFilterIsToldOfTheFurtherBiases) {
  const CatalogueEntry e = testing::every_link();
  const ImuNoise plain = e.noise();
  const ImuNoise full = only({})->noise();
  EXPECT_GT(full.gyro.turn_on_bias_sigma, plain.gyro.turn_on_bias_sigma);
  EXPECT_GT(full.accel.misalignment_sigma_rad, plain.accel.misalignment_sigma_rad);
  EXPECT_EQ(full.gyro.white_per_sqrt_hz, plain.gyro.white_per_sqrt_hz);
}

TEST(ImuConfig, MistakesAreNamed) {
  const LocalFrame frame(Geodetic{0.56, -1.58, 60.0});
  const auto refusal = [&](auto change) {
    ImuConfig c;
    c.errors = "full";
    change(c);
    const auto imu = make_imu(c, 1, frame);
    return imu.ok() ? std::string("accepted") : imu.error().str();
  };
  EXPECT_EQ(refusal([](ImuConfig& c) { c.leave_out = {"fliker"}; }),
            "imu.leave_out: " + unknown_name("", "fliker", model_names(error_links())).str());
  EXPECT_THAT(refusal([](ImuConfig& c) { c.leave_out = {"fliker"}; }), ::testing::EndsWith("; nearest is \"flicker\""));
  EXPECT_EQ(
      refusal([](ImuConfig& c) {
        c.errors = "paper";
        c.leave_out = {"flicker"};
      }),
      "imu.leave_out: the error chain \"paper\" has no links to leave out, expected an empty list, or imu.errors = "
      "\"datasheet\", \"full\", \"physics\" or \"white_only\"");
  EXPECT_EQ(refusal([](ImuConfig& c) { c.temperatures_c = {20.0}; }),
            "imu.temperatures_c: 1 temperatures for 0 times, expected as many as imu.temperature_times_s");
  EXPECT_EQ(refusal([](ImuConfig& c) {
              c.temperatures_c = {20.0, 30.0};
              c.temperature_times_s = {5.0, 5.0};
            }),
            "imu.temperature_times_s: 5 s comes after 5 s, expected times that increase");
  EXPECT_EQ(refusal([](ImuConfig& c) { c.gyroscope = "adis16405"; }),
            "imu.gyroscope: \"high_grade_mems\" has its own, expected no gyroscope beside it");
  EXPECT_EQ(refusal([](ImuConfig& c) { c.leave_out = {"flicker", "losses"}; }), "accepted");
}

}  // namespace
}  // namespace canyon::inertial
