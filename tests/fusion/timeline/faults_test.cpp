// What real receivers and drivers do to a filter, with protection and beside it without.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "canyon/core/units.h"
#include "canyon/fusion/stress/at_rest.h"
#include "canyon/fusion/timeline/filter_timeline.h"
#include "canyon/tests/fusion/driven_truth.h"
#include "canyon/tests/fusion/tactical_noise.h"

namespace canyon::fusion {
namespace {

using testing::DrivenTruth;

/// 1 m per axis, twice a second.
constexpr double kSigma_m = 1.0;
constexpr int kSamplesPerFix = 50;

struct Worst {
  double off_m = 0.0;    ///< largest error of position after the first 30 s
  double final_m = 0.0;  ///< at the end
  Incidents incidents;
};

/// What is made of each sample and fix on its way: what is delivered of it, in that order.
struct Fault {
  std::function<std::vector<ImuSample>(int k, const ImuSample&)> imu = [](int, const ImuSample& s) {
    return std::vector<ImuSample>{s};
  };
  std::function<std::vector<GnssFix>(int k, const GnssFix&)> fix = [](int, const GnssFix& f) {
    return std::vector<GnssFix>{f};
  };
};

DrivenTruth tactical(double heading_rad) {
  DrivenTruth truth(11, heading_rad);
  const ImuNoise n = tactical_noise();
  truth.bias << 1e-5, -2e-5, 1e-5, 5e-3, -6e-3, 4e-3;
  truth.gyro_per_sqrt_hz = n.gyro.white_per_sqrt_hz;
  truth.accel_per_sqrt_hz = n.accel.white_per_sqrt_hz;
  return truth;
}

ErrorStateFilter started(const DrivenTruth& truth, const std::string& keys) {
  ErrorStateFilter filter(configured(keys), tactical_noise(), DrivenTruth::frame(), Eigen::Vector3d::Zero(),
                          Eigen::Vector3d::Zero());
  filter.initialize(truth.state().t, truth.X_WB(), truth.v_W());
  return filter;
}

Worst drive(const std::string& keys, const Fault& fault, double seconds = 180.0) {
  DrivenTruth truth = tactical(0.5);
  const RandomStream stream(12, "test.fixes");
  FilterTimeline timeline(started(truth, keys), {});
  Worst out;
  for (int k = 1; k <= static_cast<int>(100 * seconds); ++k) {
    for (const ImuSample& s : fault.imu(k, truth.step())) timeline.add(s);
    if (k % kSamplesPerFix == 0) {
      const auto n = static_cast<std::uint64_t>(k);
      const Eigen::Vector3d noise(stream.normal(0, n), stream.normal(1, n), stream.normal(2, n));
      for (const GnssFix& f : fault.fix(k, truth.fix(kSigma_m * noise, kSigma_m))) timeline.add(AidingMessage(f));
    }
    out.final_m = (timeline.filter().nav_state().p_EU_E - truth.state().p_EU_E).norm();
    if (k > 3000) out.off_m = std::max(out.off_m, out.final_m);
  }
  out.incidents = timeline.incidents();
  return out;
}

void print(const char* what, const Worst& bare, const Worst& guarded) {
  std::printf("%s: at most %.1f m off, guarded %.2f m; %s\n", what, bare.off_m, guarded.off_m,
              guarded.incidents.text().c_str());
}

const std::string kBare = "filter = \"naive\"";
/// A constraint that keeps the place while fixes are refused, and tails that outliers do not pull.
const std::string kGuarded =
    "states = [\"biases\"]\nmeasurements = [\"position\", \"non_holonomic\"]\nacceptance = \"student_t\"";
/// Three sigma of the filter with sound fixes, three axes: 0.5 m each after filtering.
constexpr double kSound_m = 3.0;

TEST(Faults, NoneIsWhatItIsMeasuredAgainst) {
  const Worst bare = drive(kBare, {}), guarded = drive(kGuarded, {});
  print("no fault", bare, guarded);
  EXPECT_LT(bare.off_m, kSound_m);
  EXPECT_LT(guarded.off_m, kSound_m);
  EXPECT_EQ(guarded.incidents.text(), "");
}

TEST(Faults, OneFixInFiveIsAnywhere) {
  const RandomStream stream(13, "test.outliers");
  Fault fault;
  fault.fix = [&](int k, GnssFix fix) {
    const auto n = static_cast<std::uint64_t>(k);
    if (stream.uniform(0, n) < 0.2)
      fix.p_A_E += 100.0 * Eigen::Vector3d(stream.normal(1, n), stream.normal(2, n), stream.normal(3, n));
    return std::vector<GnssFix>{fix};
  };
  const Worst bare = drive(kBare, fault);
  for (const auto& row : acceptance_models()) {
    const std::string keys =
        "states = [\"biases\"]\nmeasurements = [\"position\", \"non_holonomic\"]\ngate_sigma = 4\n"
        "acceptance = \"" +
        std::string(row.name) + "\"";
    std::printf("  %s: %.2f m\n", row.name, drive(keys, fault).off_m);
  }
  const Worst guarded = drive(kGuarded, fault);
  print("20 % outliers of 100 m", bare, guarded);
  EXPECT_GT(bare.off_m, 10.0 * kSound_m);
  EXPECT_LT(guarded.off_m, kSound_m);
}

TEST(Faults, FixesFreezeForTenSeconds) {
  std::optional<GnssFix> held;
  Fault fault;
  fault.fix = [&](int k, GnssFix fix) {
    if (k < 6000 || k >= 7000) {
      held.reset();
    } else {
      if (!held) held = fix;
      const GpsTime t = fix.t;
      fix = *held;
      fix.t = t;
    }
    return std::vector<GnssFix>{fix};
  };
  // The bare filter is not told: nothing in a fix says that it is old.
  DrivenTruth truth = tactical(0.5);
  ErrorStateFilter filter = started(truth, kBare);
  Worst bare;
  for (int k = 1; k <= 9000; ++k) {
    filter.predict(truth.step());
    if (k % kSamplesPerFix == 0) filter.update(fault.fix(k, truth.fix(Eigen::Vector3d::Zero(), kSigma_m)).front());
    bare.off_m = std::max(bare.off_m, (filter.nav_state().p_EU_E - truth.state().p_EU_E).norm());
  }
  held.reset();
  const Worst guarded = drive(kGuarded, fault);
  print("10 s frozen", bare, guarded);
  EXPECT_GT(bare.off_m, 5.0 * kSound_m);
  EXPECT_LT(guarded.off_m, kSound_m);
  EXPECT_EQ(guarded.incidents.count(Trouble::kFrozen), 19);  // the first of twenty is one
}

TEST(Faults, LatencyNobodyDeclared) {
  std::deque<GnssFix> on_the_way;
  Fault fault;
  // 200 ms: stamped when it comes. Fixes come at ticks of half a second, so the place is carried back instead.
  DrivenTruth ahead = tactical(0.5);
  std::vector<NavState> states{ahead.state()};
  for (int k = 1; k <= 18000; ++k) {
    ahead.step();
    states.push_back(ahead.state());
  }
  fault.fix = [&](int k, GnssFix fix) {
    const auto now = static_cast<std::size_t>(k);
    fix.p_A_E += states[now - 20].p_EU_E - states[now].p_EU_E;
    return std::vector<GnssFix>{fix};
  };
  const Worst bare = drive(kBare, fault);
  const Worst guarded = drive(
      "states = [\"biases\", \"time_offset\"]\nmeasurements = [\"position\", \"non_holonomic\"]\n"
      "acceptance = \"student_t\"\ntime_offset_sigma_s = 0.2",
      fault);
  print("200 ms of latency", bare, guarded);
  EXPECT_LT(guarded.final_m, kSound_m);
  EXPECT_LT(guarded.off_m, bare.off_m);
}

TEST(Faults, SamplesAndFixesTwiceInReverseAndNotANumber) {
  Fault twice, backwards, nan;
  twice.imu = [](int, const ImuSample& s) { return std::vector<ImuSample>{s, s}; };
  twice.fix = [](int, const GnssFix& f) { return std::vector<GnssFix>{f, f, f}; };
  std::optional<ImuSample> before;
  backwards.imu = [&](int k, const ImuSample& s) {
    std::vector<ImuSample> out;
    if (k % 100 == 1) {
      before = s;
    } else if (k % 100 == 2) {
      out = {s, *before};
    } else {
      out = {s};
    }
    return out;
  };
  nan.imu = [](int k, ImuSample s) {
    if (k % 200 == 7) s.dtheta_U.z() = kNaN;
    if (k % 200 == 107) s.dv_U.x() = -std::numeric_limits<double>::infinity();
    return std::vector<ImuSample>{s};
  };
  nan.fix = [](int k, GnssFix f) {
    if (k % 200 == 0) f.p_A_E.x() = kNaN;
    if (k % 300 == 0) f.covariance_E.setZero();
    return std::vector<GnssFix>{f};
  };
  const Worst none = drive(kGuarded, {}), a = drive(kGuarded, twice), b = drive(kGuarded, backwards),
              c = drive(kGuarded, nan);
  EXPECT_EQ(a.off_m, none.off_m);  // nothing counts twice
  EXPECT_EQ(a.incidents.count(Trouble::kDuplicate), 18000 + 2 * 360);
  EXPECT_EQ(b.incidents.count(Trouble::kReversed), 180);
  EXPECT_EQ(b.incidents.count(Trouble::kGap), 180);
  EXPECT_LT(b.off_m, kSound_m);
  EXPECT_EQ(c.incidents.count(Trouble::kNotFinite), 180 + 90 + 60 - 30);
  EXPECT_LT(c.off_m, kSound_m);
}

/// So many samples with fixes that wander 200 m off, then good ones.
Fault bad_until(int samples) {
  Fault fault;
  fault.fix = [samples](int k, GnssFix fix) {
    if (k <= samples) fix.p_A_E += 200.0 * Eigen::Vector3d(std::sin(1e-4 * k), std::cos(1.3e-4 * k), 0.5);
    return std::vector<GnssFix>{fix};
  };
  return fault;
}

std::string with_acceptance(const char* acceptance) {
  return "states = [\"biases\"]\nmeasurements = [\"position\", \"non_holonomic\"]\ngate_sigma = 4\n"
         "gate_recovery_s = 5\nacceptance = \"" +
         std::string(acceptance) + "\"";
}

TEST(Faults, AnHourOfBadFixesIsForgottenInTenSeconds) {
  const Worst worst = drive(with_acceptance("gate"), bad_until(360000), 3610.0);
  std::printf("an hour of bad fixes: %.1f m off at most, %.2f m ten seconds after\n", worst.off_m, worst.final_m);
  EXPECT_LT(worst.final_m, kSound_m);
}

/// The others have no way back of their own, and trust what has lasted for longer: five minutes here.
TEST(Faults, OthersForgetSlowly) {
  for (const auto& row : acceptance_models()) {
    const double soon_m = drive(with_acceptance(row.name), bad_until(30000), 310.0).final_m,
                 late_m = drive(with_acceptance(row.name), bad_until(30000), 600.0).final_m;
    std::printf("  %s: %.2f m off after 10 s, %.2f m after 5 minutes\n", row.name, soon_m, late_m);
    EXPECT_LT(late_m, soon_m) << row.name;
  }
}

}  // namespace
}  // namespace canyon::fusion
